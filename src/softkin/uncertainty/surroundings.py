"""Which commands lie among those of `train`: their neighbours, in standardised command space, are near enough."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from sklearn.neighbors import KDTree, NearestNeighbors
from sklearn.preprocessing import StandardScaler

from softkin.core.samples import Array

#: With more commands than this scikit-learn searches neighbours without a tree.
MOST_TREE_COMMANDS = 15
#: Cells of the grid at most. More commands than a few have more.
MOST_CELLS = 1_000_000
#: One row is compared with all points where there are no more: a call of the tree takes longer.
MOST_POINTS = 10_000
#: Fewer rows are searched for in the tree at once.
FEWEST_ROWS = 1000


class Surroundings:
    """Commands of `train` (n_rows, n_commands), standardised: `mean` and `scale` (n_commands,), the distinct `points`
    (n_points, n_commands), and `gap`, the largest distance of one of them from its nearest.
    """

    def __init__(self, train_commands: Array) -> None:
        scaler = StandardScaler().fit(train_commands)
        self.mean, self.scale = scaler.mean_, scaler.scale_
        self.points = np.unique(scaler.transform(train_commands), axis=0)
        finder = NearestNeighbors(n_neighbors=1).fit(self.points)
        self.gap = float(finder.kneighbors()[0].max())
        self._nearest: Callable[[Array], Array]
        if train_commands.shape[1] > MOST_TREE_COMMANDS:
            self._nearest = lambda rows: finder.kneighbors(rows)[0][:, 0]
        else:
            tree = KDTree(self.points, leaf_size=30)
            self._nearest = lambda rows: tree.query(rows, k=1)[0][:, 0]
        self.columns = np.ascontiguousarray(self.points.T)
        self._make_cells()

    def are_far(self, commands: Array) -> NDArray[np.bool_]:
        """Which commands (n_rows, n_commands) are farther from their nearest point than `gap`, (n_rows,)."""
        rows = (commands - self.mean) / self.scale
        if len(rows) == 1 and len(self.points) <= MOST_POINTS:
            apart = self.columns - rows[0][:, None]
            apart *= apart
            return np.asarray(np.sqrt(np.add.reduce(apart).min(keepdims=True)) > self.gap)
        if self.cells is None or len(rows) < FEWEST_ROWS:
            return np.asarray(self._nearest(rows) > self.gap)
        unknown = np.flatnonzero(~self._stand_in_cells(rows))
        result = np.zeros(len(rows), dtype=bool)
        if len(unknown):
            result[unknown] = self._nearest(rows[unknown]) > self.gap
        return result

    def _make_cells(self) -> None:
        """Cells whose diagonal is just shorter than `gap`: what stands in one with a point is not far."""
        n_commands = self.points.shape[1]
        self.low, self.side = self.points.min(axis=0), self.gap / np.sqrt(n_commands) * (1 - 1e-9)
        self.cells: NDArray[np.bool_] | None = None
        if self.side == 0:
            return
        shape = np.floor(np.ptp(self.points, axis=0) / self.side) + 1
        if shape.prod() <= MOST_CELLS:
            self.cells = np.zeros(shape.astype(np.intp), dtype=bool)
            self.cells[tuple(np.floor((self.points - self.low) / self.side).astype(np.intp).T)] = True

    def _stand_in_cells(self, rows: Array) -> NDArray[np.bool_]:
        """Which rows (n_rows,) stand in the cell of a point."""
        assert self.cells is not None
        places = np.floor((rows - self.low) / self.side)
        inside = ((places >= 0) & (places < self.cells.shape)).all(axis=1)
        places[~inside] = 0
        return np.asarray(inside & self.cells[tuple(places.astype(np.intp).T)])
