"""Regressor of several targets by one of a single target."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, RegressorMixin, clone

from softkin.core.samples import Array


class PerTarget(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """A clone of `regressor` for each target; the same numbers as scikit-learn's MultiOutputRegressor.

    Differs from it in that a single target may come flat, and that predicting does not go through joblib.
    """

    def __init__(self, regressor: Any) -> None:
        self.regressor = regressor

    def fit(self, X: Array, y: Array) -> Self:
        """Fit on commands X (n_rows, n_commands) and targets y (n_rows, n_targets), or (n_rows,) of one target."""
        self.is_flat_ = y.ndim == 1
        self.estimators_ = [clone(self.regressor).fit(X, target) for target in y.reshape(len(y), -1).T]
        return self

    def predict(self, X: Array) -> Array:
        """Targets in the shape of y."""
        predicted = np.column_stack([estimator.predict(X) for estimator in self.estimators_])
        return predicted[:, 0] if self.is_flat_ else predicted
