"""scikit-learn's gradient boosting of one target, equal to the bit, with less around each of its trees."""

from __future__ import annotations

from math import ceil
from typing import Any

import numpy as np
from sklearn._loss.loss import HalfSquaredError, PinballLoss
from sklearn.ensemble import GradientBoostingRegressor
from sklearn.tree import DecisionTreeRegressor
from sklearn.tree._criterion import MSE
from sklearn.tree._splitter import BestSplitter
from sklearn.tree._tree import DepthFirstTreeBuilder, Tree

from softkin.core.samples import Array

#: The classes of the one output of a regression, as a tree wants them.
ONE_OUTPUT = np.array([1], dtype=np.intp)

#: Settings of trees and rows that are as scikit-learn has them.
PLAIN = {
    "max_leaf_nodes": None,
    "max_features": None,
    "min_samples_split": 2,
    "min_samples_leaf": 1,
    "min_weight_fraction_leaf": 0.0,
    "subsample": 1.0,
    "ccp_alpha": 0.0,
}


class QuickBoosting(GradientBoostingRegressor):  # type: ignore[misc]
    """GradientBoostingRegressor that hands rows and settings to the compiled builder of trees itself.

    scikit-learn makes an estimator of each tree, which checks all its parameters, and takes the quantile of a leaf by
    a sum of weights that are all 1. Fits with other weights, losses or trees are left to it.

    Source: scikit-learn 1.9, `BaseGradientBoosting._fit_stage` and `BaseDecisionTree._fit`.
    """

    def _fit_stage(
        self, i: int, X: Any, y: Array, raw_predictions: Array, sample_weight: Array, *others: Any, **sparse: Any
    ) -> Array:
        """Fit the tree of stage `i` and add what it predicts to `raw_predictions` (n_rows, 1); scikit-learn's `fit`
        calls it by this name.
        """
        if not self._is_plain(sample_weight, sparse):
            return np.asarray(super()._fit_stage(i, X, y, raw_predictions, sample_weight, *others, **sparse))
        random = others[-1]
        loss, raw = self._loss, raw_predictions[:, 0]
        gradient = loss.gradient(y_true=y, raw_prediction=raw_predictions, sample_weight=None)
        model = self._tree(X, -gradient, random)
        tree = model.tree_
        leaves, values = tree.apply(X), tree.value[:, 0, 0]
        if isinstance(loss, PinballLoss):
            order = np.argsort(leaves, kind="stable")
            numbers, starts = np.unique(leaves[order], return_index=True)
            parts = np.split((y - raw)[order], starts[1:])
            values[numbers] = [order_statistic(part, loss.closs.quantile) for part in parts]
        raw += self.learning_rate * values.take(leaves)
        self.estimators_[i, 0] = model
        return raw_predictions

    def _is_plain(self, sample_weight: Array, sparse: dict[str, Any]) -> bool:
        """Whether all rows count the same and trees are as they are without further settings."""
        plain = all(getattr(self, name) == value for name, value in PLAIN.items())
        known = isinstance(self._loss, HalfSquaredError | PinballLoss)
        dense = all(part is None for part in sparse.values())
        return plain and known and dense and bool((sample_weight == 1.0).all())

    def _tree(self, X: Any, y: Array, random: np.random.RandomState) -> DecisionTreeRegressor:
        """A tree fitted to y (n_rows,)."""
        model = DecisionTreeRegressor(
            max_depth=self.max_depth, min_impurity_decrease=self.min_impurity_decrease, random_state=random
        )
        n_rows, n_features = X.shape
        model.n_features_in_, model.n_outputs_, model.max_features_ = n_features, 1, n_features
        model.tree_ = Tree(n_features, ONE_OUTPUT, 1)
        splitter = BestSplitter(MSE(1, n_rows), n_features, 1, 0.0, random, None)
        depth = np.iinfo(np.int32).max if self.max_depth is None else self.max_depth
        builder = DepthFirstTreeBuilder(splitter, 2, 1, 0.0, depth, self.min_impurity_decrease)
        builder.build(model.tree_, X, y[:, None], None, None)
        return model


def order_statistic(values: Array, quantile: float) -> Any:
    """The smallest of values (n_values,) that at least a share `quantile` of them does not exceed."""
    place = max(0, ceil(100 * quantile / 100 * len(values)) - 1)
    place = min(place, len(values) - 1)
    return np.partition(values, place)[place]
