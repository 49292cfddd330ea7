"""How large errors were near a command, by numpy alone. Exported Python files hold a copy of this text."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from softkin.models.plain.kernels import Node, Values

#: Squared distances, in standardised command space, that differ by no more are the same: commands on a grid have
#: neighbours at equal distances, and which of them were the nearest would be up to rounding.
SAME_SHARE, SAME = 1e-9, 1e-18
#: Distances that are held at a time.
HELD_AT_ONCE = 4_000_000
#: Rows of a cell, were they spread evenly; and what rounding adds to distances, by far.
ROWS_OF_A_CELL, ROUNDED = 200, 1e-6
Whole = np.ndarray[Any, np.dtype[np.int64]]


def near_errors(node: Node, commands: Values) -> Values:
    """Difficulty (n_rows, n_coordinates) of commands (n_rows, n_commands), as of `HeldOutDifficulty`."""
    rows, points, shares = (commands - node["mean"]) / node["scale"], node["points"], node["shares"]
    found = np.ones((len(rows), len(shares) + 1))
    is_asked = (shares > 0) & np.isin(np.arange(len(shares)), node["column"])
    for by_norm in (False, True):
        own = np.flatnonzero((node["by_norm"] == by_norm) & is_asked)
        if len(own) and len(rows):
            one, other = (_norms(part)[:, None] if by_norm else part for part in (rows, points))
            near = _near_means(other, one, node["errors"][:, own], node["neighbours"][own])
            found[:, own] = np.maximum(shares[own] * near + (1 - shares[own]), node["least"])
    return np.asarray(found[:, node["column"]])


def _near_means(points: Values, rows: Values, errors: Values, neighbours: Whole) -> Values:
    """Mean (n_rows, n_columns) of errors (n_points, n_columns) over so many `neighbours` (n_columns,) of each row, and
    those as near. Rows are taken cell by cell: what is far from the middle of a cell is no neighbour of its rows.
    """
    means, most = np.empty((len(rows), errors.shape[1])), int(neighbours.max())
    for place in _cells(points, rows):
        some = rows[place]
        low, high = some.min(axis=0), some.max(axis=0)
        apart = _norms(points - (low + high) / 2)
        reach = np.partition(apart, most - 1)[most - 1] + np.sqrt(((high - low) ** 2).sum())
        near = np.flatnonzero(apart <= reach * (1 + ROUNDED) + ROUNDED)
        squares = squared_distances(points[near], some, False)
        for column, count in enumerate(neighbours):
            if count not in neighbours[:column]:
                same = np.flatnonzero(neighbours == count)
                means[place[:, None], same] = mean_of_nearest(squares, errors[np.ix_(near, same)], int(count))
    return means


def _cells(points: Values, rows: Values) -> list[Whole]:
    """Places of rows (n_rows, n_features) that lie in one cell of a grid over the points, some at a time."""
    n_features, most = rows.shape[1], max(1, HELD_AT_ONCE // points.size)
    n_sides = int((len(rows) / ROWS_OF_A_CELL) ** (1 / n_features))
    order, edges = np.arange(len(rows)), np.zeros(0, dtype=np.int64)
    if n_sides > 1:
        low, span = points.min(axis=0), np.maximum(np.ptp(points, axis=0), SAME)
        sides = np.clip((rows - low) / span * n_sides, 0, n_sides - 1).astype(np.int64)
        cell = sides @ n_sides ** np.arange(n_features)
        order = np.argsort(cell, kind="stable")
        edges = np.flatnonzero(np.diff(cell[order])) + 1
    parts = np.split(order, edges)
    return [part[start : start + most] for part in parts for start in range(0, len(part), most)]


def _norms(rows: Values) -> Values:
    return np.asarray(np.sqrt((rows * rows).sum(axis=1)))


def mean_of_nearest(squares: Values, errors: Values, neighbours: int) -> Values:
    """Mean (n_rows, n_columns) of errors (n_points, n_columns) over the nearest points and those that are as near, by
    squared distances (n_rows, n_points).
    """
    farthest = np.partition(squares, neighbours - 1, axis=1)[:, neighbours - 1, None]
    near = (squares <= farthest * (1 + SAME_SHARE) + SAME).astype(np.float64)
    return np.asarray(near @ errors / near.sum(axis=1)[:, None])


def squared_distances(points: Values, rows: Values, by_norm: bool) -> Values:
    """Squared distances (n_rows, n_points) between standardised commands, or between their norms."""
    if by_norm:
        return np.asarray((_norms(rows)[:, None] - _norms(points)) ** 2)
    squares = (rows[:, :1] - points[:, 0]) ** 2
    for place in range(1, points.shape[1]):
        apart = rows[:, place, None] - points[:, place]
        apart *= apart
        squares += apart
    return np.asarray(squares)


def of_one_command(node: Node) -> Callable[[Values], Values]:
    """The function from one command (1, n_commands) to its difficulty (1, n_coordinates), as `near_errors`: what does
    not depend on the command is worked out once, and distances are put in order once for all columns.
    """
    points, shares = np.ascontiguousarray(node["points"].T), node["shares"]
    norms, mean, scale = np.sqrt((points * points).sum(axis=0)), node["mean"], node["scale"]
    kinds = []
    for by_norm in (False, True):
        own = np.flatnonzero((node["by_norm"] == by_norm) & (shares > 0))
        if len(own):
            places = node["neighbours"][own] - 1
            errors = np.ascontiguousarray(node["errors"][:, own])
            kinds.append((by_norm, own, places, np.unique(places), errors, shares[own], 1 - shares[own]))

    def answer(commands: Values) -> Values:
        row = (commands[0] - mean) / scale
        near = np.ones(len(shares) + 1)
        for by_norm, own, places, distinct, errors, share, rest in kinds:
            apart = np.sqrt((row * row).sum()) - norms if by_norm else points - row[:, None]
            squares = apart * apart if by_norm else (apart * apart).sum(axis=0)
            farthest = np.partition(squares, distinct)[places] * (1 + SAME_SHARE) + SAME
            some = np.flatnonzero(squares <= farthest.max())
            is_near = squares[some, None] <= farthest
            means = (errors.take(some, axis=0) * is_near).sum(axis=0) / is_near.sum(axis=0)
            near[own] = np.maximum(share * means + rest, node["least"])
        return near[node["column"]][None]

    return answer
