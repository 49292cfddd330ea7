"""scikit-learn's histogram boosting of one target, equal to the bit, with less around each of its trees."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from sklearn._loss.loss import PinballLoss
from sklearn.ensemble import HistGradientBoostingRegressor
from sklearn.ensemble._hist_gradient_boosting.binning import _BinMapper
from sklearn.ensemble._hist_gradient_boosting.common import PREDICTOR_RECORD_DTYPE, X_BITSET_INNER_DTYPE
from sklearn.ensemble._hist_gradient_boosting.predictor import TreePredictor
from sklearn.utils import check_random_state
from sklearn.utils._openmp_helpers import _openmp_effective_n_threads
from sklearn.utils.validation import _check_y, check_consistent_length

from softkin.core.samples import Array
from softkin.models.estimators.histogram_trees import Grower, leaves_of


class QuickHistograms(HistGradientBoostingRegressor):  # type: ignore[misc]
    """HistGradientBoostingRegressor whose trees a `Grower` grows; what that does not know (weights, missing values,
    categories, constraints, early stopping, losses of other hessians) is left to scikit-learn.
    """

    def fit(self, X: Array, y: Array, sample_weight: Array | None = None, **others: Any) -> Self:
        """Fit on commands X (n_rows, n_commands) and one target y (n_rows,)."""
        if not self._is_plain(X, sample_weight, others):
            super().fit(X, y, sample_weight, **others)
            return self
        self._validate_params()
        X, _ = self._preprocess_X(X, reset=True)
        y = self._encode_y(_check_y(y, estimator=self))
        check_consistent_length(X, y)
        self._n_features = X.shape[1]
        self._loss = self._get_loss(sample_weight=None) if isinstance(self.loss, str) else self.loss
        self.do_early_stopping_, self._use_validation_data, self._scorer = False, False, None
        self.train_score_, self.validation_score_ = np.empty(0), np.empty(0)
        self._boost(y, self._grower(X))
        return self

    def _is_plain(self, X: Array, sample_weight: Array | None, others: dict[str, Any]) -> bool:
        plain = (self.early_stopping, self.warm_start, self.max_leaf_nodes) == (False, False, None)
        free = self.monotonic_cst is None and self.interaction_cst is None and self.categorical_features == "from_dtype"
        known = self.loss == "squared_error" or isinstance(self.loss, PinballLoss)
        told = sample_weight is not None or others or not isinstance(X, np.ndarray)
        return plain and free and known and not told and bool(np.isfinite(X).all())

    def _grower(self, X: Array) -> Grower:
        """The grower of the bins of X; draws seeds in scikit-learn's order."""
        random, threads = check_random_state(self.random_state), _openmp_effective_n_threads()
        seeds = [random.randint(np.iinfo(np.uint32).max, dtype="u8") for _ in range(2)]
        self._random_seed, self._feature_subsample_rng = seeds[0], np.random.default_rng(seeds[1])
        self._bin_mapper = _BinMapper(n_bins=self.max_bins + 1, random_state=seeds[0], n_threads=threads)
        return Grower(
            self._bin_mapper.fit_transform(X),
            self._bin_mapper,
            max_depth=self.max_depth,
            min_samples_leaf=self.min_samples_leaf,
            max_features=self.max_features,
            l2_regularization=self.l2_regularization,
            rng=self._feature_subsample_rng,
            threads=threads,
        )

    def _boost(self, y: Array, grower: Grower) -> None:
        """Grow `max_iter` trees, each on the gradients at what those before it predict."""
        loss, rate, threads = self._loss, self.learning_rate, grower.splitter.n_threads
        self._baseline_prediction = loss.fit_intercept_only(y_true=y, sample_weight=None).reshape((1, -1))
        raw = np.zeros(len(y)) + self._baseline_prediction[0]
        records: list[list[Any]] = []
        for _ in range(self.max_iter):
            loss.closs.gradient(y, raw, None, grower.gradients, threads)
            root = grower.grow()
            leaves, rows = leaves_of(root), grower.rows
            sizes = [leaf.n_rows for leaf in leaves]
            if loss.differentiable:
                for leaf in leaves:
                    leaf.value *= rate
            else:
                rest, start = y[rows] - raw[rows], 0
                for leaf, size in zip(leaves, sizes, strict=True):
                    leaf.value = rate * loss.fit_intercept_only(y_true=rest[start : start + size], sample_weight=None)
                    start += size
            raw[rows] += np.repeat([leaf.value for leaf in leaves], sizes)
            records.append([])
            grower.records(root, records[-1])
        nodes = np.array([record for of_tree in records for record in of_tree], dtype=PREDICTOR_RECORD_DTYPE)
        ends = np.cumsum([len(of_tree) for of_tree in records])[:-1]
        self._predictors = [
            [TreePredictor(each.copy(), no_categories(), no_categories())] for each in np.split(nodes, ends)
        ]


def no_categories() -> Any:
    """The bits of the categories that go left, of a tree that knows none."""
    return np.zeros((0, 8), dtype=X_BITSET_INNER_DTYPE)
