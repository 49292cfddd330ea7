"""Samples: rows of commands and positions, their subsets and the names of their columns.

Array shapes, stated once: commands ``(n_rows, n_commands)``; positions ``(n_rows, n_coordinates)`` in mm with
``n_coordinates = 3 * n_markers``, ordered m1_x, m1_y, m1_z, m2_x, ...
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Params = dict[str, Any]

TRAIN, VALIDATION, TEST, EXTRAPOLATION = SUBSETS = ("train", "validation", "test", "extrapolation")

#: A coordinate whose range on `train` is at most this (mm) is constant: it says nothing about a model.
CONSTANT_RANGE_MM = 1e-6
#: Arithmetic on larger numbers overflows.
MAX_MAGNITUDE = 1e100


@dataclass(frozen=True, slots=True)
class Samples:
    """Rows of one subset: `commands` (n_rows, n_commands), `positions` (n_rows, n_coordinates) in mm."""

    commands: Array
    positions: Array

    def __len__(self) -> int:
        return len(self.commands)


def command_columns(n_commands: int) -> list[str]:
    """Names u1, u2, ... of the command columns."""
    return [f"u{i + 1}" for i in range(n_commands)]


def coordinate_columns(n_markers: int) -> list[str]:
    """Names m1_x, m1_y, m1_z, m2_x, ... of the coordinate columns."""
    return [f"m{i + 1}_{axis}" for i in range(n_markers) for axis in "xyz"]


def informative_coordinates(train_positions: Array) -> NDArray[np.bool_]:
    """Mask (n_coordinates,) of the coordinates that move on `train` (range above `CONSTANT_RANGE_MM`)."""
    return np.asarray(np.ptp(train_positions, axis=0) > CONSTANT_RANGE_MM)
