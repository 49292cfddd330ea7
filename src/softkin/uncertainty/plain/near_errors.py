"""How large errors were near a command, by numpy alone. Exported Python files hold a copy of this text."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from softkin.models.plain.kernels import Node, Values

#: Squared distances, in standardised command space, that differ by no more are the same: commands on a grid have
#: neighbours at equal distances, and which of them were the nearest would be up to rounding.
SAME_SHARE, SAME = 1e-9, 1e-18
#: Distances that are held at a time.
HELD_AT_ONCE = 4_000_000


def near_errors(node: Node, commands: Values) -> Values:
    """Difficulty (n_rows, n_coordinates) of commands (n_rows, n_commands), as of `HeldOutDifficulty`."""
    step = max(1, HELD_AT_ONCE // node["points"].size)
    parts = [_columns(node, commands[start : start + step]) for start in range(0, len(commands), step)]
    found = np.concatenate(parts) if parts else np.ones((0, len(node["shares"])))
    return np.asarray(np.hstack([found, np.ones((len(found), 1))])[:, node["column"]])


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
        one, other = (np.sqrt((part * part).sum(axis=1)) for part in (rows, points))
        return np.asarray((one[:, None] - other) ** 2)
    apart = rows[:, None] - points
    return np.asarray((apart * apart).sum(axis=2))


def _columns(node: Node, commands: Values) -> Values:
    """Difficulty (n_rows, n_columns) by each column of errors."""
    rows = (commands - node["mean"]) / node["scale"]
    found = np.ones((len(rows), len(node["shares"])))
    for by_norm in (False, True):
        own = np.flatnonzero((node["by_norm"] == by_norm) & (node["shares"] > 0))
        squares = squared_distances(node["points"], rows, by_norm) if len(own) else rows
        for column in own:
            near = mean_of_nearest(squares, node["errors"][:, [column]], int(node["neighbours"][column]))[:, 0]
            share = node["shares"][column]
            found[:, column] = np.maximum(share * near + (1 - share), node["least"])
    return found


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
