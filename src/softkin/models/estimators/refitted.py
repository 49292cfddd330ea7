"""Regressor that looks up the predictions of refits: lets MAPIE cross-calibrate stored predictions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, RegressorMixin

from softkin.core.samples import Array


class Refits:
    """Stored predictions (n_rows,) by the rows that were fitted on, and those `of_all` rows.

    A copy is the object itself, so that cloning costs nothing.
    """

    def __init__(self, predictions: Mapping[bytes, Array], of_all: Array) -> None:
        self.predictions = predictions
        self.of_all = of_all

    def __deepcopy__(self, memo: object) -> Self:
        return self


def key(rows: NDArray[Any]) -> bytes:
    """The key of a fit: the numbers of its rows, in their order."""
    return np.asarray(rows, dtype=np.int64).tobytes()


class Refitted(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """`fit(X, y)` looks up the refit on the rows numbered in X (n_rows, 1); `predict(X)` returns its predictions of
    the rows numbered in X.

    For rows that no refit was fitted on (MAPIE fits all rows for its point prediction) it predicts `Refits.of_all`.
    """

    def __init__(self, refits: Refits) -> None:
        self.refits = refits

    def fit(self, X: Array, y: Array) -> Self:  # noqa: ARG002 (scikit-learn's signature)
        """Look up the predictions of this fit."""
        self.predictions_ = self.refits.predictions.get(key(X[:, 0]), self.refits.of_all)
        return self

    def predict(self, X: Array) -> Array:
        """Stored predictions (n_rows,)."""
        return self.predictions_[np.asarray(X)[:, 0].astype(np.int64)]
