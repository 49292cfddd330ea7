"""scikit-learn's random forest, equal to the bit, with less around each of its trees."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from sklearn.ensemble import RandomForestRegressor
from sklearn.tree import DecisionTreeRegressor
from sklearn.tree._criterion import MSE
from sklearn.tree._splitter import BestSplitter
from sklearn.tree._tree import DepthFirstTreeBuilder, Tree
from sklearn.utils import check_random_state
from sklearn.utils.validation import check_is_fitted, validate_data

from softkin.core.samples import Array

#: Settings that are as scikit-learn has them.
PLAIN = {
    "criterion": "squared_error",
    "max_leaf_nodes": None,
    "min_samples_split": 2,
    "min_weight_fraction_leaf": 0.0,
    "min_impurity_decrease": 0.0,
    "max_samples": None,
    "monotonic_cst": None,
    "oob_score": False,
    "warm_start": False,
    "ccp_alpha": 0.0,
}
#: Seeds of trees are drawn below it, as scikit-learn draws them.
SEEDS = np.iinfo(np.int32).max


class QuickForest(RandomForestRegressor):  # type: ignore[misc]
    """RandomForestRegressor that hands rows and settings to the compiled builder of trees itself.

    scikit-learn clones an estimator for each tree, sends it through joblib, checks its weights and makes two generators
    for it: a third of a fit on a few hundred rows. Fits with weights, or with settings other than those that a forest
    here has, are left to it.

    Source: scikit-learn 1.9, `BaseForest.fit` and `BaseDecisionTree._fit`.
    """

    def fit(self, X: Array, y: Array, sample_weight: Array | None = None) -> Self:
        """Fit on commands X (n_rows, n_commands) and targets y (n_rows, n_targets), or (n_rows,) of one target."""
        if sample_weight is not None or not self._is_plain(X):
            super().fit(X, y, sample_weight)
            return self
        self._validate_params()
        X, y = validate_data(self, X, y, multi_output=True, dtype=np.float32)
        y = np.ascontiguousarray(y.reshape(len(y), -1), dtype=np.float64)
        self._n_samples, self.n_outputs_ = y.shape
        self._sample_weight, self._n_samples_bootstrap = None, len(y) if self.bootstrap else None
        self._validate_estimator()
        random, own = check_random_state(self.random_state), np.random.RandomState()
        seeds = [random.randint(SEEDS) for _ in range(self.n_estimators)]
        self.estimators_ = [self._tree(X, y, seed, own) for seed in seeds]
        return self

    def predict(self, X: Array) -> Array:
        """Targets in the shape of y."""
        check_is_fitted(self)
        rows = self._validate_X_predict(X)
        total = np.zeros((len(rows), self.n_outputs_))
        for one in self.estimators_:
            total += one.tree_.predict(rows).reshape(total.shape)
        total /= len(self.estimators_)
        return total[:, 0] if self.n_outputs_ == 1 else total

    def _is_plain(self, X: Any) -> bool:
        plain = all(getattr(self, name) == value for name, value in PLAIN.items())
        known = isinstance(self.max_features, float | int) and isinstance(self.min_samples_leaf, int)
        return plain and known and isinstance(X, np.ndarray) and bool(np.isfinite(X).all())

    def _tree(self, X: Any, y: Array, seed: int, random: np.random.RandomState) -> DecisionTreeRegressor:
        """A tree of a bootstrap sample of the rows, or of all; `random` is seeded anew for what it draws."""
        (n_rows, n_features), n_targets, depth = X.shape, y.shape[1], self.max_depth
        share = self.max_features
        n_chosen = share if isinstance(share, int) else max(1, int(share * n_features))
        counts = None
        if self.bootstrap:
            random.seed(seed)
            counts = np.bincount(random.randint(0, n_rows, n_rows), minlength=n_rows).astype(np.float64)
        settings = {name: getattr(self, name) for name in ("max_depth", "min_samples_leaf", "max_features")}
        model = DecisionTreeRegressor(**settings, random_state=seed)
        model.n_features_in_, model.n_outputs_, model.max_features_ = n_features, n_targets, n_chosen
        model.tree_ = Tree(n_features, np.ones(n_targets, dtype=np.intp), n_targets)
        random.seed(seed)
        least = self.min_samples_leaf
        splitter = BestSplitter(MSE(n_targets, n_rows), n_chosen, least, 0.0, random, None)
        deepest = np.iinfo(np.int32).max if depth is None else depth
        builder = DepthFirstTreeBuilder(splitter, max(2, 2 * least), least, 0.0, deepest, 0.0)
        builder.build(model.tree_, X, y, counts, None)
        return model
