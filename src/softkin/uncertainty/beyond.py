"""Commands beyond those of `train`: which they are, and how wide bounds are there, what can be worked out once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.core.shells import command_norm
from softkin.uncertainty.calibration_data import PointCalibration, Shell, ShellCalibration
from softkin.uncertainty.conformal import conformal_limits
from softkin.uncertainty.error_growth import ErrorGrowth, fit_error_growth, shell_distances, train_radius
from softkin.uncertainty.intervals.rolling_shells import largest_limits
from softkin.uncertainty.surroundings import Surroundings

Levels = tuple[float, ...]
#: Limits of so many choices of levels are kept.
KEPT_LEVELS = 64


class Beyond:
    """What `in_domain_and_extrapolation` says of extrapolation, without fitting anything for each command.

    Parameters:
        known: calibration data of the deployed method, without new rows.
        shells, norm: as of the calibrated model.
    """

    def __init__(self, known: PointCalibration, shells: Sequence[Shell], norm: Callable[[Array], Array] | None) -> None:
        self.known, self.has_shells = known, norm is not None
        self.norm = norm or command_norm(known.train_commands, standardised=True).of
        self.data = ShellCalibration(known, shells, self.norm)
        self.radius = train_radius(self.data)
        self.limits = lru_cache(KEPT_LEVELS)(self._limits_at)

    def place(self, commands: Array, norms: Array | None = None) -> tuple[NDArray[np.bool_], Array]:
        """Which commands (n_rows, n_commands) lie in extrapolation, and command norms, both (n_rows,); `norms` where
        they are known.
        """
        norms = np.asarray(self.norm(commands)) if norms is None else norms
        outside = np.asarray(norms > self.radius)
        within = np.flatnonzero(~outside)
        if len(within) == len(outside):
            outside = self.surroundings.are_far(commands)
        elif len(within):
            outside[within] = self.surroundings.are_far(commands[within])
        return outside, norms

    def half_widths(self, commands: Array, levels: Levels) -> Array:
        """Half-widths (n_levels, n_rows, n_coordinates) in mm that commands (n_rows, n_commands) have where they lie in
        extrapolation; there must be shells.
        """
        limits, of_growths = self.limits(levels)
        distances = np.maximum(self.norm(commands) / self.radius, 1.0)
        widest = np.broadcast_to(limits[:, None], (len(levels), len(commands), limits.shape[-1]))
        for growth, largest in zip(self.growths, of_growths, strict=True):
            widest = np.maximum(widest, largest[:, None] * growth.of_new(distances))
        return np.asarray(widest)

    @cached_property
    def surroundings(self) -> Surroundings:
        """The neighbours of commands."""
        return Surroundings(self.known.train_commands)

    @cached_property
    def growths(self) -> list[ErrorGrowth]:
        """The error-growth models of the shells."""
        return fit_error_growth(self.data)

    def _limits_at(self, levels: Levels) -> tuple[Array, list[Array]]:
        """Limits (n_levels, n_coordinates) of the errors on the calibration set, and those of each error-growth model,
        in units of what it predicts.
        """
        errors, places = np.abs(self.known.truth - self.known.calibration), shell_distances(self.data)
        of_growths = [largest_limits(self.data.shells, growth, places, levels) for growth in self.growths]
        return conformal_limits(errors, levels), of_growths
