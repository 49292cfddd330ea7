"""Bending and length of the arcs from base to markers: nearly linear in the commands where positions are not."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.preprocessing import StandardScaler

from softkin.core.errors import SoftkinError
from softkin.core.geometry.base_frame import base_frame
from softkin.core.geometry.constant_curvature import from_arcs, in_domain, spread_of_points, to_arcs
from softkin.core.samples import CONSTANT_RANGE_MM, Array
from softkin.models.estimators.position_scaler import PositionScaler
from softkin.models.target_spaces.spec import TargetSpace

#: What rounding leaves of a coordinate that never varies (rad, mm).
ROUNDING = 1e-9


class CurvatureCoordinates(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """Positions -> standardised arcs of the markers that move, then the standardised coordinates, of those that do not,
    which tremble all the same: a model in positions predicts them, too. Others come back as they were.

    `base` may declare `origin` and `axis`. Coordinates of an arc that never vary are left out, whatever
    `skip_constant` says of positions.
    """

    def __init__(self, skip_constant: bool = True, base: Mapping[str, Any] | None = None) -> None:
        self.skip_constant = skip_constant
        self.base = base

    def fit(self, X: Array, y: Array) -> Self:
        """Learn frame and scale from positions X (n_rows, n_coordinates) in mm at commands y (n_rows, n_commands).

        Raises:
            SoftkinError: no arc leads to a marker.
        """
        points = _points(X)
        self.frame_ = base_frame(y, points, self.base)
        # The mean of equal numbers may be off in its last bit.
        self.resting_ = np.where(np.ptp(points, axis=0) > 0, points.mean(axis=0), points[0])
        self.moving_ = np.ptp(points, axis=0).max(axis=1) > CONSTANT_RANGE_MM
        if not self.moving_.any():
            raise SoftkinError("no marker moves on `train`, so there are no arcs; mend: target_spaces: [cartesian]")
        self.scaler_ = PositionScaler(skip_constant=True, least_range=ROUNDING).fit(self._arcs(points))
        self.n_arcs_ = int(self.scaler_.kept_.sum())
        self.trembling_ = ~np.repeat(self.moving_, 3) & (np.ptp(X, axis=0) > 0)
        self.tremble_scaler_ = StandardScaler().fit(X[:, self.trembling_]) if self.trembling_.any() else None
        return self

    def transform(self, X: Array) -> Array:
        """Positions (n_rows, n_coordinates) in mm -> standardised arcs (n_rows, n_varying) and what trembles."""
        arcs = self.scaler_.transform(self._arcs(_points(X)))
        if self.tremble_scaler_ is None:
            return arcs
        return np.column_stack([arcs, self.tremble_scaler_.transform(X[:, self.trembling_])])

    def inverse_transform(self, X: Array) -> Array:
        """Standardised arcs, and what trembles -> positions in mm."""
        arcs, rest = np.split(X, [self.n_arcs_], axis=1)
        points = np.tile(self.resting_, (len(X), 1, 1))
        points[:, self.moving_] = self.frame_.from_base(from_arcs(_points(self.scaler_.inverse_transform(arcs))))
        positions = points.reshape(len(X), -1)
        if self.tremble_scaler_ is not None:
            positions[:, self.trembling_] = self.tremble_scaler_.inverse_transform(rest)
        return positions

    def inverse_spread(self, X: Array, spread: Array) -> Array:
        """Standardised spreads around standardised arcs X -> spreads (n_rows, n_coordinates) in mm, to first order."""
        (X, _), (spread, rest) = (np.split(whole, [self.n_arcs_], axis=1) for whole in (X, spread))
        arcs = _points(self.scaler_.inverse_transform(X))
        along = spread_of_points(arcs, _points(self.scaler_.inverse_spread(X, spread)), self.frame_.axes().T)
        result = np.zeros((len(X), len(self.resting_), 3))
        result[:, self.moving_] = along
        flat = result.reshape(len(X), -1)
        if self.tremble_scaler_ is not None:
            flat[:, self.trembling_] = rest * self.tremble_scaler_.scale_
        return flat

    def _arcs(self, points: Array) -> Array:
        moving = self.frame_.to_base(points[:, self.moving_])
        outside = np.argwhere(np.logical_not(in_domain(moving)))
        if len(outside):
            row, marker = outside[0]
            place = np.flatnonzero(self.moving_)[marker]
            raise SoftkinError(
                f"{len(outside)} positions lie at the base or straight behind it, where no arc leads (first: row {row},"
                f" marker {place + 1}, at {np.round(points[row, place], 3).tolist()} mm; base at "
                f"{np.round(self.frame_.origin, 3).tolist()}, axis {np.round(self.frame_.axis, 3).tolist()}); mend: "
                "declare `base` in the dataset's entry, or set target_spaces: [cartesian]"
            )
        return to_arcs(moving).reshape(len(points), -1)


def _points(positions: Array) -> Array:
    return np.asarray(positions, dtype=np.float64).reshape(len(positions), -1, 3)


def transformer(skip_constant: bool, base: Mapping[str, Any] | None) -> CurvatureCoordinates:
    """Arcs standardised."""
    return CurvatureCoordinates(skip_constant, base)


SPACE = TargetSpace("curvature", "Curvature", transformer)
