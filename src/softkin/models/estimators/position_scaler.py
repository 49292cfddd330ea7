"""Standardise positions and leave out coordinates that never vary."""

from __future__ import annotations

from typing import Self

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.preprocessing import StandardScaler

from softkin.core.samples import Array


class PositionScaler(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """Zero mean and unit variance per coordinate; with `skip_constant`, a coordinate without any variation is not
    handed to the model and comes back as its constant. One whose range is at most `least_range` has no variation.
    """

    def __init__(self, skip_constant: bool = True, least_range: float = 0.0) -> None:
        self.skip_constant = skip_constant
        self.least_range = least_range

    def fit(self, X: Array, y: Array | None = None) -> Self:  # noqa: ARG002 (scikit-learn's signature)
        """Learn the scale from positions X (n_rows, n_coordinates) in mm."""
        self.constants_ = X[0].copy()
        varies = np.ptp(X, axis=0) > self.least_range
        self.kept_ = varies if self.skip_constant and varies.any() else np.ones(X.shape[1], dtype=bool)
        self.scaler_ = StandardScaler().fit(X[:, self.kept_])
        return self

    def transform(self, X: Array) -> Array:
        """Positions in mm -> standardised positions of the kept coordinates."""
        return np.asarray(self.scaler_.transform(X[:, self.kept_]))

    def inverse_transform(self, X: Array) -> Array:
        """Standardised positions of the kept coordinates -> positions (n_rows, n_coordinates) in mm."""
        positions = np.tile(self.constants_, (len(X), 1))
        positions[:, self.kept_] = self.scaler_.inverse_transform(X)
        return positions

    def inverse_spread(self, X: Array, spread: Array) -> Array:  # noqa: ARG002 (the same around any position)
        """Standardised spreads of the kept coordinates around X -> spreads (n_rows, n_coordinates) in mm."""
        result = np.zeros((len(spread), len(self.constants_)))
        result[:, self.kept_] = spread * self.scaler_.scale_
        return result
