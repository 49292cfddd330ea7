"""Regressor that returns one column of its input: lets MAPIE calibrate stored predictions."""

from __future__ import annotations

from typing import Self

import numpy as np
from sklearn.base import BaseEstimator, RegressorMixin

from softkin.core.samples import Array


class Column(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """`predict(X)` returns column `index` of X (n_rows, n_predictions)."""

    def __init__(self, index: int = 0) -> None:
        self.index = index
        self.fitted_ = True

    def fit(self, X: Array, y: Array | None = None) -> Self:  # noqa: ARG002 (scikit-learn's signature)
        """Nothing to learn."""
        return self

    def predict(self, X: Array) -> Array:
        """The stored predictions (n_rows,)."""
        return np.asarray(X)[:, self.index]
