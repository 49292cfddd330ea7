"""Cells of command space in which all commands are near to those of `train`, or all are far from them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array

#: What a cell tells of the rows in it.
UNKNOWN, NEAR, FAR = 0, 1, 2
#: Cells at most whose middles are looked at; and in which only those that hold a point are told.
MOST_LOOKED_AT, MOST_CELLS = 40_000, 1_000_000
#: The diagonal of a cell is as long as `gap`, or such a part of it.
PARTS = (8, 4, 2, 1)
#: Distances are known to this share of them.
ROUNDED = 1e-9


@dataclass(frozen=True)
class Grid:
    """Cells of equal `side` from the corner `low` (n_commands,) on, and what each tells. What lies beyond the outermost
    cells is taken to lie in them.
    """

    low: Array
    side: float
    cells: NDArray[np.int8]

    def told(self, rows: Array) -> NDArray[np.int8]:
        """What is told of rows (n_rows, n_commands), each `UNKNOWN`, `NEAR` or `FAR`."""
        places = np.zeros(len(rows), dtype=np.int64)
        for column, (low, n_cells) in enumerate(zip(self.low, self.cells.shape, strict=True)):
            along = np.minimum(np.maximum((rows[:, column] - low) / self.side, 0.0), n_cells - 1.0)
            places *= n_cells
            places += along.astype(np.int64)
        return np.asarray(self.cells.ravel().take(places))


def grid_of(points: Array, gap: float, nearest: Callable[[Array], Array]) -> Grid | None:
    """The grid over points (n_points, n_commands), of which rows are near that are at most `gap` from one of them;
    `nearest` has the distances (n_rows,) of rows (n_rows, n_commands). None where there would be too many cells.
    """
    n_commands = points.shape[1]
    if gap == 0:
        return None
    for parts in PARTS:
        side = gap / np.sqrt(n_commands) * (1 - ROUNDED) / parts
        # Beyond the outermost cells all is farther than the gap from the points.
        around = int(np.ceil(gap / side)) + 2
        shape = (np.floor(np.ptp(points, axis=0) / side) + 1 + 2 * around).astype(np.float64)
        if shape.prod() <= MOST_LOOKED_AT or (parts == 1 and shape.prod() <= MOST_CELLS):
            break
    else:
        return None
    low, size = points.min(axis=0) - around * side, tuple(int(number) for number in shape)
    cells = np.full(size, UNKNOWN, dtype=np.int8)
    if cells.size <= MOST_LOOKED_AT:
        middles = low + side * (np.indices(size).reshape(n_commands, -1).T + 0.5)
        distances, half = nearest(middles).reshape(size), 0.5 * side * np.sqrt(n_commands)
        cells[distances + half <= gap * (1 - ROUNDED)] = NEAR
        cells[distances - half > gap * (1 + ROUNDED)] = FAR
    cells[tuple(np.floor((points - low) / side).astype(np.int64).T)] = NEAR
    return Grid(low, float(side), cells)
