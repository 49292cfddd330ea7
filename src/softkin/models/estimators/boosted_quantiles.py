"""One gradient boosting per quantile."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, RegressorMixin

from softkin.core.samples import Array
from softkin.models.estimators.boosted_trees import boosted_trees


class BoostedQuantiles(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """Predicts (n_rows, n_quantiles); quantiles may cross, since each is fitted by itself."""

    def __init__(self, quantiles: Sequence[float], params: Mapping[str, Any], random_state: int = 0) -> None:
        self.quantiles = quantiles
        self.params = params
        self.random_state = random_state

    def fit(self, X: Array, y: Array) -> Self:
        """Fit on commands X (n_rows, n_commands) and one coordinate y (n_rows,)."""
        self.models_ = [
            boosted_trees(dict(self.params), self.random_state, quantile).fit(X, y) for quantile in self.quantiles
        ]
        return self

    def predict(self, X: Array) -> Array:
        """Predicted quantiles (n_rows, n_quantiles)."""
        return np.column_stack([model.predict(X) for model in self.models_])
