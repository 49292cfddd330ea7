"""What of a calibrated model's answers does not depend on the command, worked out once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.core.shells import command_norm
from softkin.uncertainty.calibration_data import PointCalibration, Shell, ShellCalibration
from softkin.uncertainty.conformal import around, conformal_limits
from softkin.uncertainty.error_growth import ErrorGrowth, fit_error_growth, shell_distances, train_radius
from softkin.uncertainty.intervals.rolling_shells import largest_limits
from softkin.uncertainty.intervals.spec import IntervalMethod

Levels = tuple[float, ...]
#: Limits of so many choices of levels are kept.
KEPT_LEVELS = 64
#: With more commands than this scikit-learn searches neighbours without a tree.
MOST_TREE_COMMANDS = 15


class Prepared:
    """The same bounds as `method` and `in_domain_and_extrapolation` give, without fitting anything for each command.

    Parameters:
        method: the deployed method.
        known: its calibration data, without new rows.
        shells, norm: as of the calibrated model.
    """

    def __init__(
        self,
        method: IntervalMethod[Any],
        known: PointCalibration,
        shells: Sequence[Shell],
        norm: Callable[[Array], Array] | None,
    ) -> None:
        self.method, self.known = method, known
        self.has_shells = norm is not None
        self.norm = norm or command_norm(known.train_commands, standardised=True).of
        self.data = ShellCalibration(known, shells, self.norm)
        self.radius = train_radius(self.data)
        self._sides = lru_cache(KEPT_LEVELS)(self._sides_at)
        self._limits = lru_cache(KEPT_LEVELS)(self._limits_at)

    def in_domain(self, data: PointCalibration, levels: Levels) -> Array:
        """Intervals (n_levels, n_rows, n_coordinates, 2) in mm of the deployed method at the new rows of `data`."""
        if self.method.has_constant_width and not self.method.calibrated_on.has_spread:
            return np.asarray(data.new[..., None] + self._sides(levels))
        return np.asarray(self.method.intervals(data, levels))

    def everywhere(self, data: PointCalibration, bounds: Array, levels: Levels) -> Array:
        """In-domain `bounds` (n_levels, n_rows, n_coordinates, 2) at the new rows of `data`; in extrapolation what
        `in_domain_and_extrapolation.intervals` makes of them, where there are shells.
        """
        if not self.has_shells:
            return bounds
        outside = self.is_outside(data.new_commands)
        if not outside.any():
            return bounds
        wider = around(data.new, self.half_widths_outside(data.new_commands, levels))
        if self.method.calibrated_on.has_spread:
            lower, upper = np.minimum(bounds[..., 0], wider[..., 0]), np.maximum(bounds[..., 1], wider[..., 1])
            wider = np.stack([lower, upper], axis=-1)
        return np.where(outside[:, None, None], wider, bounds)

    def half_widths_outside(self, commands: Array, levels: Levels) -> Array:
        """Half-widths (n_levels, n_rows, n_coordinates) in mm that commands (n_rows, n_commands) have where they lie in
        extrapolation; there must be shells.
        """
        limits, of_growths = self._limits(levels)
        distances = np.maximum(self.norm(commands) / self.radius, 1.0)
        widest = np.broadcast_to(limits, (len(levels), len(commands), limits.shape[-1]))
        for growth, largest in zip(self.growths, of_growths, strict=True):
            widest = np.maximum(widest, largest[:, None] * growth.of_new(distances))
        return np.asarray(widest)

    def is_outside(self, commands: Array) -> NDArray[np.bool_]:
        """Which commands (n_rows, n_commands) lie in extrapolation, (n_rows,); as
        `in_domain_and_extrapolation.is_in_extrapolation`.
        """
        scaler, tree, widest_gap = self._neighbours
        nearest = tree((commands - scaler.mean_) / scaler.scale_)
        return np.asarray((nearest > widest_gap) | (self.norm(commands) > self.radius))

    def make_ready(self, levels: Levels) -> None:
        """Work everything out now, for these levels, so that the first command takes no longer than the others."""
        self.is_outside(self.known.train_commands[:1])
        if self.method.has_constant_width and not self.method.calibrated_on.has_spread:
            self._sides(levels)
        if self.has_shells:
            self._limits(levels)

    @cached_property
    def growths(self) -> list[ErrorGrowth]:
        """The error-growth models of the shells."""
        return fit_error_growth(self.data)

    @cached_property
    def _neighbours(self) -> tuple[Any, Callable[[Array], Array], float]:
        """Scaler of commands, the distance (n_rows,) of scaled commands to their nearest of `train`, its widest gap."""
        from sklearn.neighbors import KDTree, NearestNeighbors
        from sklearn.preprocessing import StandardScaler

        train = self.known.train_commands
        scaler = StandardScaler().fit(train)
        distinct = np.unique(scaler.transform(train), axis=0)
        finder = NearestNeighbors(n_neighbors=1).fit(distinct)
        widest_gap = float(finder.kneighbors()[0].max())
        if train.shape[1] > MOST_TREE_COMMANDS:
            return scaler, lambda rows: finder.kneighbors(rows)[0][:, 0], widest_gap
        tree = KDTree(distinct, leaf_size=30)
        return scaler, lambda rows: tree.query(rows, k=1)[0][:, 0], widest_gap

    def _sides_at(self, levels: Levels) -> Array:
        """Minus and plus the half-widths (n_levels, 1, n_coordinates, 2): the bounds around a position of 0."""
        from dataclasses import replace

        zero = replace(
            self.known, new=np.zeros((1, self.known.truth.shape[1])), new_commands=self.known.train_commands[:1]
        )
        return np.asarray(self.method.intervals(zero, levels))

    def _limits_at(self, levels: Levels) -> tuple[Array, list[Array]]:
        """Limits (n_levels, 1, n_coordinates) of the errors on the calibration set, and those of each error-growth
        model (n_levels, n_coordinates), in units of what it predicts.
        """
        errors, places = np.abs(self.known.truth - self.known.calibration), shell_distances(self.data)
        of_growths = [largest_limits(self.data.shells, growth, places, levels) for growth in self.growths]
        return conformal_limits(errors, levels)[:, None], of_growths
