"""Regressor from commands to positions that is fitted in a target space."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, RegressorMixin, clone

from softkin.core.samples import Array


class KinematicRegressor(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """Fits `regressor` to positions that `transformer` takes to targets, and maps its predictions back to mm.

    Differs from scikit-learn's TransformedTargetRegressor in that the transformer is fitted on the commands too: the
    first `n_commands` columns, all where it is None.
    """

    def __init__(self, regressor: Any, transformer: Any, n_commands: int | None = None) -> None:
        self.regressor = regressor
        self.transformer = transformer
        self.n_commands = n_commands

    def fit(self, X: Array, y: Array) -> Self:
        """Fit on commands X (n_rows, n_commands) and positions y (n_rows, n_coordinates) in mm."""
        self.transformer_ = clone(self.transformer).fit(y, X[:, : self.n_commands])
        targets = self.transformer_.transform(y)
        self.regressor_ = clone(self.regressor).fit(X, targets[:, 0] if targets.shape[1] == 1 else targets)
        return self

    def predict(self, X: Array) -> Array:
        """Positions (n_rows, n_coordinates) in mm."""
        return np.asarray(self.transformer_.inverse_transform(self.targets(X)))

    def resolved(self, X: Array) -> tuple[Any, Array, Array]:
        """The kinematic regressor, what it is given of X, and what is added to its positions (mm): nothing."""
        return self, X, np.zeros((len(X), 1))

    def targets(self, X: Array) -> Array:
        """What the regressor itself predicts (n_rows, n_targets), standardised."""
        return np.asarray(self.regressor_.predict(X)).reshape(len(X), -1)
