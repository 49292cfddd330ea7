"""Samples: rows of commands and positions, their subsets and the names of their columns.

Array shapes, stated once: commands ``(n_rows, n_commands)``; positions ``(n_rows, n_coordinates)`` in mm with
``n_coordinates = 3 * n_markers``, ordered m1_x, m1_y, m1_z, m2_x, ...
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from softkin.core.recording import Recording

Array = NDArray[np.float64]
Params = dict[str, Any]

TRAIN, VALIDATION, TEST, EXTRAPOLATION = SUBSETS = ("train", "validation", "test", "extrapolation")

#: A coordinate whose range on `train` is at most this (mm) is constant: it says nothing about a model.
CONSTANT_RANGE_MM = 1e-6
#: Fewest rows of each subset that the whole workflow can do something with. `validation` is split into this many folds
#: where interval methods are compared; on fewer rows of `train` no model can be tuned on folds and shells.
MIN_CALIBRATION_ROWS = 5
MIN_ROWS = {TRAIN: 20, VALIDATION: MIN_CALIBRATION_ROWS, TEST: 2, EXTRAPOLATION: 2}
#: From as many rows of `validation` on, intervals at 95 % are finite: 0.95 (n + 1) <= n. Source: Lei et al. (2018).
ROWS_FOR_95_PERCENT = 19
#: Arithmetic on larger numbers overflows.
MAX_MAGNITUDE = 1e100


@dataclass(frozen=True, slots=True)
class Samples:
    """Rows of one subset: `commands` (n_rows, n_commands), `positions` (n_rows, n_coordinates) in mm.

    `recording` says when they were measured, where the dataset knows it. `block` (n_rows,) numbers what was split as a
    whole, a stretch of time or a group, where that was not each row for itself: rows of one block are alike.
    `orientation` (n_rows, 3) holds rotation vectors of the tip in rad, where the dataset's entry names them: about the
    mean of `train`, and as a reader gives them about none.
    """

    commands: Array
    positions: Array
    recording: Recording | None = None
    block: NDArray[np.int64] | None = None
    orientation: Array | None = None

    def __len__(self) -> int:
        return len(self.commands)

    def __setstate__(self, state: list[Any]) -> None:
        """The values of the fields; what a model of an earlier version lacks has its default."""
        defaults = [field.default for field in fields(self)]
        for field, value in zip(fields(self), [*state, *defaults[len(state) :]], strict=True):
            object.__setattr__(self, field.name, value)

    @property
    def inputs(self) -> Array:
        """What a model is given of each row: its command, and where there is a recording its memory and session."""
        if self.recording is None:
            return self.commands
        return np.column_stack([self.commands, self.recording.memory, self.recording.session])

    def take(self, rows: NDArray[Any] | slice) -> Self:
        """Some of the rows."""
        recording = None if self.recording is None else self.recording.take(rows)
        block = None if self.block is None else self.block[rows]
        orientation = None if self.orientation is None else self.orientation[rows]
        return replace(
            self,
            commands=self.commands[rows],
            positions=self.positions[rows],
            recording=recording,
            block=block,
            orientation=orientation,
        )


def command_columns(n_commands: int) -> list[str]:
    """Names u1, u2, ... of the command columns."""
    return [f"u{i + 1}" for i in range(n_commands)]


def coordinate_columns(n_markers: int) -> list[str]:
    """Names m1_x, m1_y, m1_z, m2_x, ... of the coordinate columns."""
    return [f"m{i + 1}_{axis}" for i in range(n_markers) for axis in "xyz"]


#: Names of the columns of an orientation.
ROTATION_COLUMNS = [f"rotation_{axis}" for axis in "xyz"]


def measured_coordinates(positions: Array) -> NDArray[np.bool_]:
    """Mask (n_coordinates,) of the coordinates that averages are over: all, but of a planar robot two of each marker.

    A planar robot's third coordinates are exactly 0 in every row: readers add them, and nobody measured them.
    """
    mask = np.ones(positions.shape[1], dtype=bool)
    mask[2::3] = bool(positions[:, 2::3].any())
    return mask


def informative_coordinates(train_positions: Array) -> NDArray[np.bool_]:
    """Mask (n_coordinates,) of the coordinates that move on `train` (range above `CONSTANT_RANGE_MM`)."""
    return np.asarray(np.ptp(train_positions, axis=0) > CONSTANT_RANGE_MM)
