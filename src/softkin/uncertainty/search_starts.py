"""Commands of `train` that searches for targets begin at."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array

#: Searches begin at commands whose poses are nearest, no two of them nearer to each other than this share of the range.
N_STARTS, LEAST_APART = 4, 0.2


class SearchStarts:
    """Commands whose predicted positions are nearest to targets, apart from each other, and the last command: for each
    target the nearest, the last, and the others; where targets are reached in a row, the last before all.

    Parameters:
        targets: (n_targets, 3) in mm.
        positions: (n_rows, 3) in mm, what is predicted at `commands`.
        commands: (n_rows, n_commands), between the bounds of the search.
        width: (n_commands,), the range that distances between commands are shares of.
        last: the command (n_commands,) sent before, between the bounds.
        in_a_row: whether targets are reached in a row.
    """

    def __init__(
        self, targets: Array, positions: Array, commands: Array, width: Array, last: Array | None, *, in_a_row: bool
    ) -> None:
        self.commands, self.points, self.last = commands, commands / width, last
        self.far = _squared_distances(targets, positions)
        self.taken = np.full(len(targets), -1)
        self.n_rounds = N_STARTS + (last is not None)
        self.place_of_last = None if last is None else 0 if in_a_row else 1

    def of_round(self, place: int, targets: NDArray[np.intp]) -> Array:
        """The commands (n_rows, n_commands) that searches of some targets (n_rows,) begin at in a round, from 0, NaN
        where there is none left. Rounds are asked for one after the other, of no target that one before left out.
        """
        if self.last is not None and place == self.place_of_last:
            return np.tile(self.last, (len(targets), 1))
        taken, far = self.taken[targets], self.far if len(targets) == len(self.far) else self.far[targets]
        if (taken >= 0).any():
            far[_squared_distances(self.points[taken], self.points) < LEAST_APART**2] = np.inf
            self.far[targets] = far
        self.taken[targets] = nearest = far.argmin(axis=1)
        none_left = np.isinf(far[np.arange(len(far)), nearest])
        return np.where(none_left[:, None], np.nan, self.commands[nearest])


def _squared_distances(some: Array, others: Array) -> Array:
    """(n_some, n_others) between rows, not exact where rows are nearly alike."""
    squares = some @ (-2 * others.T)
    squares += np.square(others).sum(axis=1)
    squares += np.square(some).sum(axis=1)[:, None]
    return np.asarray(squares)
