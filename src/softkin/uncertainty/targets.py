"""What people wish of a robot, checked: targets of a marker, which marker, how near, how large a step."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.errors import ConfigError, DataError
from softkin.core.samples import Array
from softkin.uncertainty import calls


@dataclass(frozen=True, slots=True)
class TargetNames(calls.Names):
    """What the columns of one marker are called."""

    marker: int = 0

    @classmethod
    def of_marker(cls, names: calls.Names, marker: int) -> TargetNames:
        """From those of the whole robot."""
        first = marker * names.dimensions
        own = names.own_positions[first : first + names.dimensions]
        return cls(names.n_commands, 3, names.own_commands, own, names.scale, names.dimensions, names.unit, marker)

    @property
    def coordinates(self) -> list[str]:
        """m2_x, m2_y, m2_z of the second marker."""
        return [f"m{self.marker + 1}_{axis}" for axis in "xyz"]


def marker_of(marker: Any, n_markers: int, where: str) -> int:
    """The number of a marker from 0; negative ones count from the end.

    Raises:
        ConfigError: there is no such marker.
    """
    if isinstance(marker, Integral) and not isinstance(marker, bool) and -n_markers <= int(marker) < n_markers:
        return int(marker) % n_markers
    raise ConfigError(
        f"{marker!r} is no marker of this robot", where=where, fix=f"pass a number from 0 to {n_markers - 1}, or -1"
    )


def target_rows(targets: calls.Rows, names: calls.Names, marker: int, where: str) -> Array:
    """Finite targets (n_rows, 3) in mm of a marker, from whatever holds them.

    Raises:
        DataError: another shape, no numbers, not finite, other columns than the marker's.
    """
    of_marker = TargetNames.of_marker(names, marker)
    if isinstance(targets, pd.Series):
        targets = targets.to_frame().T.infer_objects()
    if isinstance(targets, pd.DataFrame):
        targets = of_marker.positions_in(targets, where)
    rows = calls.numbers(targets, "targets", where)
    rows = rows.reshape(1, -1) if rows.ndim < 2 else rows
    if rows.ndim != 2 or rows.shape[1] != 3 or not len(rows):
        raise DataError(
            f"expected targets of shape (n_rows, 3), got {np.shape(targets)}",
            where=where,
            fix=f"pass x, y and z in {names.unit} of one marker in each row",
        )
    calls.check_finite(rows, targets, of_marker.coordinates, where)
    return rows


def checked_tolerance(tolerance: Any, where: str) -> float | None:
    """A tolerance in mm, or None.

    Raises:
        ConfigError: it is no positive number.
    """
    if tolerance is None:
        return None
    is_number = isinstance(tolerance, Real) and not isinstance(tolerance, (bool, np.bool_))
    if not is_number or not 0 < float(tolerance) < np.inf:
        raise ConfigError(f"{tolerance!r} is no tolerance", where=where, fix="pass a positive number of mm")
    return float(tolerance)


def checked_step(max_step: Any, n_commands: int, where: str) -> Array | None:
    """How much each command (n_commands,) may change at most, or None.

    Raises:
        DataError: no number, or not one for each command; not positive.
    """
    if max_step is None:
        return None
    step = calls.numbers(max_step, "max_step", where)
    if step.shape not in ((), (n_commands,)) or not (np.isfinite(step) & (step > 0)).all():
        raise DataError(
            f"max_step is {max_step!r}", where=where, fix=f"pass one positive number, or {n_commands} of them"
        )
    return np.broadcast_to(step, (n_commands,)).astype(np.float64)
