"""Where the deployed intervals hold least: the worst small region of commands, and commands at which poses may fail.

A region is a box along one command or two. It is searched on the rows of `validation`, and its coverage is that on
`test`: picking the worst of many regions does not bias it.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from softkin.core.metrics.interval import covered
from softkin.core.samples import Array, Samples, command_columns, informative_coordinates
from softkin.uncertainty.calibrated_model import CalibratedModel

#: A region has at least so many rows of `validation`, and at most this share of them.
FEWEST_ROWS, LARGEST_SHARE = 20, 0.5
#: Of more commands, pairs are tried of those along which the worst region of one command is worst.
MOST_COMMANDS = 24
#: Bounds that are tried along a command, where regions are along one, and along two.
MOST_BOUNDS = {1: 120, 2: 20}

logger = logging.getLogger("softkin")


class Region(NamedTuple):
    """Commands between `low` and `high` (n_columns,), both included, in the `columns` of a table of commands."""

    columns: tuple[int, ...]
    low: Array
    high: Array

    def holds(self, commands: Array) -> NDArray[np.bool_]:
        """Which commands (n_rows, n_commands) lie in it, (n_rows,)."""
        rows = commands[:, self.columns]
        return np.asarray(((self.low <= rows) & (rows <= self.high)).all(axis=1))

    def __str__(self) -> str:
        names = command_columns(max(self.columns) + 1)
        sides = zip(self.columns, self.low, self.high, strict=True)
        return ", ".join(f"{names[column]} {low:.4g} to {high:.4g}" for column, low, high in sides)


def deployed_rows(
    robot: CalibratedModel, validation: Samples, test: Samples, confidence_level: float
) -> Iterator[dict[str, Any]]:
    """Rows of conditional_coverage.csv of the intervals that a calibrated model gives.

    `by` small_region: the worst along one command and along two, `value` its coverage on `validation`. `by` failure,
    where poses fail: rows of `test` that may fail at this level, and the others, `value` their mean probability.
    """
    moving = informative_coordinates(robot.train.positions)
    held = [
        covered(rows.positions, np.asarray(robot.intervals(rows.inputs, confidence_level)))[:, moving].mean(axis=1)
        for rows in (validation, test)
    ]
    for n_columns in MOST_BOUNDS:
        region = worst_region(validation.commands, 1 - held[0], n_columns)
        if region is not None:
            searched, rows = region.holds(validation.commands), region.holds(test.commands)
            yield {
                "by": "small_region",
                "group": str(region),
                "value": held[0][searched].mean(),
                **share(held[1][rows]),
            }
    if robot.failures is not None:
        probability = robot.failures.probability(test.commands)
        may_fail = robot.failures.may_fail(test.commands, [confidence_level])[0]
        for group, rows in (("may fail", may_fail), ("others", ~may_fail)):
            value = probability[rows].mean() if rows.any() else float("nan")
            yield {"by": "failure", "group": group, "value": value, **share(held[1][rows])}


def share(held: Array) -> dict[str, Any]:
    """Rows, mean share of coordinates that are held, and its standard error; NaN where rows are none, or one."""
    n_rows = len(held)
    error = held.std(ddof=1) / np.sqrt(n_rows) if n_rows > 1 else float("nan")
    return {"n_rows": n_rows, "coverage": held.mean() if n_rows else float("nan"), "standard_error": error}


def worst_region(commands: Array, missed: Array, n_columns: int) -> Region | None:
    """The region along so many commands whose rows miss by most, in standard errors of their mean above that of all.

    Parameters:
        commands: (n_rows, n_commands).
        missed: share of missed coordinates of each row (n_rows,).
        n_columns: 1 or 2.

    Returns:
        None where there are fewer commands, too few rows, or rows that all miss alike.
    """
    if len(commands) < 2 * FEWEST_ROWS or commands.shape[1] < n_columns or np.ptp(missed) == 0:
        return None
    excess = (missed - missed.mean()) / missed.std()
    tried: Sequence[int] = range(commands.shape[1])
    if n_columns > 1 and len(tried) > MOST_COMMANDS:
        logger.info("regions along two commands are searched for %d of %d commands", MOST_COMMANDS, len(tried))
        alone = [_along(commands, (column,), excess)[0] for column in tried]
        tried = sorted(np.argsort(alone, kind="stable")[-MOST_COMMANDS:].tolist())
    best, region = 0.0, None
    for columns in combinations(tried, n_columns):
        score, sides, cells = _along(commands, columns, excess)
        if score > best:
            own = np.all(
                [(low <= cell) & (cell < high) for cell, (low, high) in zip(cells, sides, strict=True)], axis=0
            )
            rows = commands[np.ix_(own, columns)]
            best, region = score, Region(columns, rows.min(axis=0), rows.max(axis=0))
    return region


def _along(
    commands: Array, columns: tuple[int, ...], excess: Array
) -> tuple[float, list[tuple[int, int]], list[NDArray[np.intp]]]:
    """The score and the sides of the worst rectangle along one command or two, and the cells (n_rows,) of each."""
    n_columns = len(columns)
    cuts = [_cuts(commands[:, column], MOST_BOUNDS[n_columns]) for column in columns]
    cells = [np.searchsorted(of, commands[:, c], side="right") - 1 for of, c in zip(cuts, columns, strict=True)]
    # Along one command the other side of the grid has one cell.
    cells, sizes = ([np.zeros(len(commands), dtype=int)] * (2 - n_columns) + cells, [1] * (2 - n_columns))
    score, sides = _worst_rectangle(cells, sizes + [len(of) for of in cuts], excess)
    return score, sides, cells


def _cuts(values: Array, most: int) -> Array:
    """Lower ends of cells along a command: its distinct values, or as many as `most` with the same number of rows."""
    distinct = np.unique(values)
    return distinct if len(distinct) <= most else np.unique(np.quantile(values, np.arange(most) / most, method="lower"))


def _worst_rectangle(
    cells: list[NDArray[np.intp]], sizes: list[int], excess: Array
) -> tuple[float, list[tuple[int, int]]]:
    """The largest sum of `excess` (n_rows,) of a rectangle of cells over the root of its rows, and its sides, each from
    a cell up to another, which does not belong to it.
    """
    sums = []
    for weights in (np.ones(len(excess)), excess):
        grid = np.zeros(sizes)
        np.add.at(grid, tuple(cells), weights)
        sums.append(np.pad(grid.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0))))
    best, sides = 0.0, [(0, sizes[0]), (0, sizes[1])]
    for low, high in combinations(range(sizes[0] + 1), 2):
        count, total = ((of[high] - of[low])[None] - (of[high] - of[low])[:, None] for of in sums)
        allowed = (count >= FEWEST_ROWS) & (count <= LARGEST_SHARE * len(excess))
        scores = np.where(allowed, total / np.sqrt(np.maximum(count, 1)), -np.inf)
        place = np.unravel_index(int(np.argmax(scores)), scores.shape)
        if scores[place] > best:
            best, sides = float(scores[place]), [(low, high), (int(place[0]), int(place[1]))]
    return best, sides
