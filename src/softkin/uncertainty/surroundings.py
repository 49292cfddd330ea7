"""Which commands lie among those of `train`: their neighbours, in standardised command space, are near enough."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from sklearn.neighbors import KDTree, NearestNeighbors
from sklearn.preprocessing import StandardScaler

from softkin.core.samples import Array
from softkin.uncertainty.cells import FAR, UNKNOWN, Grid, grid_of

#: With more commands than this scikit-learn searches neighbours without a tree.
MOST_TREE_COMMANDS = 15
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

    def are_far(self, commands: Array) -> NDArray[np.bool_]:
        """Which commands (n_rows, n_commands) are farther from their nearest point than `gap`, (n_rows,)."""
        rows = (commands - self.mean) / self.scale
        if len(rows) == 1 and len(self.points) <= MOST_POINTS:
            apart = self.columns - rows[0][:, None]
            apart *= apart
            return np.asarray(np.sqrt(np.add.reduce(apart).min(keepdims=True)) > self.gap)
        if len(rows) < FEWEST_ROWS or self.grid is None:
            return np.asarray(self._nearest(rows) > self.gap)
        told = self.grid.told(rows)
        result, unknown = told == FAR, np.flatnonzero(told == UNKNOWN)
        if len(unknown):
            result[unknown] = self._nearest(rows[unknown]) > self.gap
        return np.asarray(result)

    @cached_property
    def grid(self) -> Grid | None:
        """Cells that tell near rows from far ones without a search; None where there would be too many."""
        return grid_of(self.points, self.gap, self._nearest)
