"""Gradient boosting of one target by either of scikit-learn's ways to split: at every value, or between bins."""

from __future__ import annotations

from typing import Any

import numpy as np
from sklearn._loss.loss import PinballLoss

from softkin.core.samples import Array, Params
from softkin.models.estimators.quick_boosting import QuickBoosting
from softkin.models.estimators.quick_histograms import QuickHistograms

#: The parameter that names the way to split, and its value for histograms; both as XGBoost has them.
TREE_METHOD, HISTOGRAM = "tree_method", "hist"


def boosted_trees(params: Params, seed: int, quantile: float | None = None) -> Any:
    """Unfitted ensemble for one target: its mean, or a `quantile` of it.

    With `tree_method: hist` among `params` it is a HistGradientBoostingRegressor of the others, without early stopping;
    else the paper's GradientBoostingRegressor(**params).
    """
    rest = dict(params)
    if rest.pop(TREE_METHOD, None) == HISTOGRAM:
        loss: Params = {} if quantile is None else {"loss": QuantileLoss(quantile=quantile)}
        fixed = {"early_stopping": False, "max_leaf_nodes": None}
        return QuickHistograms(**loss, **fixed, **rest, random_state=seed)
    loss = {} if quantile is None else {"loss": "quantile", "alpha": quantile}
    return QuickBoosting(**loss, **rest, random_state=seed)


class QuantileLoss(PinballLoss):  # type: ignore[misc]
    """scikit-learn's pinball loss, equal to the bit; it takes the quantile of a leaf by one partition.

    numpy.percentile, with its checks, took nearly half of a fit: a call per leaf.
    """

    def fit_intercept_only(self, y_true: Array, sample_weight: Array | None = None) -> Any:
        """The quantile of y_true (n_rows,), between the two nearest rows by linear interpolation."""
        if sample_weight is not None:
            return super().fit_intercept_only(y_true, sample_weight)
        place = (len(y_true) - 1) * (100 * self.closs.quantile / 100)  # numpy's quantile of the percentile
        below = int(place)
        above = min(below + 1, len(y_true) - 1)
        ordered = np.partition(y_true, (below, above))
        low, high, share = ordered[below], ordered[above], place - below
        # The two forms that numpy chooses from.
        return low + (high - low) * share if share < 0.5 else high - (high - low) * (1.0 - share)
