"""Curvature target space: bending and length of the arcs from base to markers, nearly linear in the commands."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.preprocessing import StandardScaler

from softkin.core.errors import DataError
from softkin.core.geometry.base_frame import base_frame
from softkin.core.geometry.constant_curvature import from_arcs, has_arc, spread_of_points, to_arcs
from softkin.core.samples import CONSTANT_RANGE_MM, Array
from softkin.models.estimators.position_scaler import PositionScaler
from softkin.models.target_spaces.spec import TargetSpace

#: Range (rad, mm) up to which a coordinate of an arc differs by rounding alone.
ROUNDING = 1e-9


class CurvatureCoordinates(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """Positions -> standardised arcs of the moving markers, then the standardised near-constant coordinates of the
    other markers, which a model in positions predicts too. Constant coordinates are no targets and come back as their
    constant.

    `base` may declare `origin` and `axis`. Constant coordinates of an arc are left out, whatever `skip_constant` says
    of positions.
    """

    def __init__(self, skip_constant: bool = True, base: Mapping[str, Any] | None = None) -> None:
        self.skip_constant = skip_constant
        self.base = base

    def fit(self, X: Array, y: Array) -> Self:
        """Learn frame and scale from positions X (n_rows, n_coordinates) in mm at commands y (n_rows, n_commands).

        Raises:
            DataError: no marker moves, or no arc leads to a position.
        """
        points = _points(X)
        self.frame_ = base_frame(y, points, self.base)
        # The mean of equal numbers may be off in its last bit.
        self.constants_ = np.where(np.ptp(points, axis=0) > 0, points.mean(axis=0), points[0])
        self.moving_ = np.ptp(points, axis=0).max(axis=1) > CONSTANT_RANGE_MM
        if not self.moving_.any():
            raise DataError(
                "no marker moves, so there are no arcs", where="`train`", fix="set target_spaces: [cartesian]"
            )
        self.scaler_ = PositionScaler(skip_constant=True, least_range=ROUNDING).fit(self._arcs(points))
        self.n_arcs_ = int(self.scaler_.kept_.sum())
        self.near_constant_ = ~np.repeat(self.moving_, 3) & (np.ptp(X, axis=0) > 0)
        near_constant = X[:, self.near_constant_]
        self.near_constant_scaler_ = StandardScaler().fit(near_constant) if self.near_constant_.any() else None
        return self

    def transform(self, X: Array) -> Array:
        """Positions (n_rows, n_coordinates) in mm -> standardised targets (n_rows, n_targets)."""
        arcs = self.scaler_.transform(self._arcs(_points(X)))
        if self.near_constant_scaler_ is None:
            return arcs
        return np.column_stack([arcs, self.near_constant_scaler_.transform(X[:, self.near_constant_])])

    def inverse_transform(self, X: Array) -> Array:
        """Standardised arcs and near-constant coordinates -> positions (n_rows, n_coordinates) in mm."""
        arcs, near_constant = np.split(X, [self.n_arcs_], axis=1)
        points = np.tile(self.constants_, (len(X), 1, 1))
        points[:, self.moving_] = self.frame_.from_base(from_arcs(_points(self.scaler_.inverse_transform(arcs))))
        positions = points.reshape(len(X), -1)
        if self.near_constant_scaler_ is not None:
            positions[:, self.near_constant_] = self.near_constant_scaler_.inverse_transform(near_constant)
        return positions

    def inverse_spread(self, X: Array, spread: Array) -> Array:
        """Standardised spreads around targets X -> spreads (n_rows, n_coordinates) in mm, to first order."""
        (targets, _), (of_arcs, of_near_constant) = (np.split(both, [self.n_arcs_], axis=1) for both in (X, spread))
        arcs = _points(self.scaler_.inverse_transform(targets))
        points = np.zeros((len(X), len(self.constants_), 3))
        points[:, self.moving_] = spread_of_points(
            arcs, _points(self.scaler_.inverse_spread(targets, of_arcs)), self.frame_.axes().T
        )
        positions = points.reshape(len(X), -1)
        if self.near_constant_scaler_ is not None:
            positions[:, self.near_constant_] = of_near_constant * self.near_constant_scaler_.scale_
        return positions

    def _arcs(self, points: Array) -> Array:
        moving = self.frame_.to_base(points[:, self.moving_])
        without_arc = np.argwhere(np.logical_not(has_arc(moving)))
        if len(without_arc):
            row, moving_marker = without_arc[0]
            marker = np.flatnonzero(self.moving_)[moving_marker]
            raise DataError(
                f"{len(without_arc)} positions lie at the base or straight behind it, where no arc leads (the first at "
                f"{np.round(points[row, marker], 3).tolist()} mm; base at {np.round(self.frame_.origin, 3).tolist()}, "
                f"axis {np.round(self.frame_.axis, 3).tolist()})",
                where=f"row {row}, marker {marker + 1}",
                fix="declare `base` in the dataset's entry, or set target_spaces: [cartesian]",
            )
        return to_arcs(moving).reshape(len(points), -1)


def _points(positions: Array) -> Array:
    return np.asarray(positions, dtype=np.float64).reshape(len(positions), -1, 3)


def transformer(skip_constant: bool, base: Mapping[str, Any] | None) -> CurvatureCoordinates:
    """Unfitted transformer of positions to standardised arcs."""
    return CurvatureCoordinates(skip_constant, base)


SPACE = TargetSpace("curvature", "Curvature", transformer)
