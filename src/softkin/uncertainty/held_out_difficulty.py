"""How hard commands are for a model, by its errors on held-out folds of `train`, and on no row of `validation`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.models.plain.kernels import Node
from softkin.uncertainty.plain.near_errors import mean_of_nearest, near_errors, squared_distances

#: Of so many nearest commands the errors are averaged; the mean has one of these shares, that of all rows the rest.
NEIGHBOURS = (10, 20, 40, 80, 160)
SHARES = (0.25, 0.5, 0.75, 1.0)
#: No command is easier than this, where 1 is the mean.
LEAST = 0.05
#: An error counts as at most so many times the 90 % quantile: a few gross errors say nothing of their neighbours.
LARGEST = 3.0
#: Rows that are kept at most: all distances between them are held, and files of models hold them.
MOST_ROWS = 2000
#: By how many of its standard errors the likelihood must be larger than that of one mean for all rows.
STANDARD_ERRORS = 2.0


@dataclass(frozen=True)
class HeldOutDifficulty:
    """The mean error near a command, in units of that of all rows, coordinate by coordinate.

    Near are the `neighbours` nearest commands, in standardised command space, or those of the nearest norm there
    (`by_norm`). Which of both, how many, and what share the mean over all rows keeps, is told by rows left out one
    by one: the likelihood of their errors, exponential of the mean that the others foretell. Where none is likelier
    than one mean for all rows by two standard errors, all commands are equally hard, and intervals have one width.

    Of `points` (n_rows, n_commands), commands standardised by `mean` and `scale`, `errors` (n_rows, n_columns) are
    known; a coordinate has the `column` (n_coordinates,) of its own, or that of the mean of all; -1: it is constant.
    Source: Papadopoulos, Vovk and Gammerman (2011), with errors on held-out rows; crepes' DifficultyEstimator.
    """

    mean: Array
    scale: Array
    points: Array
    errors: Array
    by_norm: NDArray[np.bool_]
    neighbours: NDArray[np.int64]
    shares: Array
    column: NDArray[np.int64]

    def of(self, commands: Array) -> Array:
        """Difficulty (n_rows, n_coordinates) of commands (n_rows, n_commands)."""
        return near_errors(self.numbers, commands)

    @property
    def numbers(self) -> Node:
        """The same in plain numbers, as `near_errors` reads them."""
        return vars(self) | {"least": LEAST}


def fit_difficulty(commands: Array, errors: Array, column: NDArray[np.int64]) -> HeldOutDifficulty:
    """The difficulty by absolute `errors` (n_rows, n_columns) in mm on held-out rows, at `commands` (n_rows,
    n_commands); `column` (n_coordinates,) of each coordinate.
    """
    from softkin.core.rows import sampled_rows  # it imports pandas, which Snakemake need not at its start

    some = sampled_rows(len(commands), MOST_ROWS, 0)
    commands, errors = commands[some], errors[some]
    mean, scale = commands.mean(axis=0), commands.std(axis=0)
    scale = np.where(scale > 0, scale, 1.0)
    capped = np.minimum(errors, LARGEST * np.quantile(errors, 0.9, axis=0))
    typical = capped.mean(axis=0)
    relative = capped / np.where(typical > 0, typical, 1.0)
    points = (commands - mean) / scale
    flat = _unlikelihoods(relative, np.ones_like(relative))
    best = np.where(typical > 0, flat.mean(axis=0), -np.inf)
    by_norm, shares = np.zeros(len(best), dtype=bool), np.zeros(len(best))
    neighbours = np.ones(len(best), dtype=np.int64)
    for is_norm, count, near in _left_out(points, relative):
        for share in SHARES:
            rows = _unlikelihoods(relative, np.maximum(share * near + (1 - share), LEAST))
            by_chance = (flat - rows).std(axis=0) / np.sqrt(len(rows))
            means = rows.mean(axis=0)
            better = (means < best) & (flat.mean(axis=0) - means > STANDARD_ERRORS * by_chance)
            by_norm[better], neighbours[better], shares[better] = is_norm, count, share
            best = np.where(better, means, best)
    return HeldOutDifficulty(mean, scale, points, relative, by_norm, neighbours, shares, column)


def _left_out(points: Array, errors: Array) -> Iterator[tuple[bool, int, Array]]:
    """By norm or not, number of neighbours, and the mean error (n_rows, n_columns) of those of each row but itself."""
    rows = np.arange(len(points))
    for by_norm in (False, True):
        squares = np.empty((len(points), len(points)))
        for row in rows:  # a row at a time: all differences at once are as many as the commands times the squares
            squares[row] = squared_distances(points, points[[row]], by_norm)[0]
        squares[rows, rows] = np.inf
        for count in NEIGHBOURS:
            if count < len(points) - 1:
                yield by_norm, count, mean_of_nearest(squares, errors, count)


def _unlikelihoods(errors: Array, told: Array) -> Array:
    """Minus the logarithm (n_rows, n_columns) of the likelihood of each error (n_rows, n_columns), exponential of the
    means that are `told`.
    """
    return np.asarray(np.log(told) + errors / told)
