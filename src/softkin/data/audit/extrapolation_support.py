"""Check that extrapolation lies beyond train: command norms, and the share of rows off the convex hull of `train`.

A row is off the hull when a plane separates its command from all train commands. The plane across the line from the
centre of train is tried first; then the best one is sought by linear programming (scipy, HiGHS), which works with any
number of commands: first against a few train commands, then also against those on the wrong side of that plane, until
there are none (off the hull) or no plane is left (within it). The result is that of all `hull` commands at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import command_scale, first_of_each, row_groups, sampled_rows
from softkin.core.samples import EXTRAPOLATION, SUBSETS, TRAIN, Array, Samples
from softkin.data.audit.findings import WARNING, CheckResult, Finding

MAX_HULL, MAX_ROWS_CHECKED = 50_000, 100
#: With less than this share of extrapolation off the hull, most of it is interpolation.
FEWEST_OFF_HULL = 0.5
#: Nearer to the hull than this (in standard deviations of the commands on train) counts as within.
TOLERANCE = 1e-9


def off_hull(points: Array, hull: Array) -> NDArray[np.bool_]:
    """Mask (n_points,) of `points` (n_points, n_columns) off the convex hull of the rows of `hull`."""
    centre = hull.mean(axis=0)
    points, hull = points - centre, hull - centre
    return np.array([_is_off_hull(point, hull) for point in points])


def _is_off_hull(point: Array, hull: Array) -> bool:
    from scipy.optimize import linprog

    along, length = hull @ point, np.linalg.norm(point)
    if along.max() < length**2 - TOLERANCE * length:
        return True
    tried = _largest(along, 4 * len(point))
    while True:
        # Maximise a x - b over |a_j| <= 1 with a h <= b for each tried row h of the hull; above 0, a plane separates.
        best = linprog(
            np.append(-point, 1.0),
            A_ub=np.column_stack([hull[tried], -np.ones(len(tried))]),
            b_ub=np.zeros(len(tried)),
            bounds=[(-1.0, 1.0)] * len(point) + [(None, None)],
            method="highs",
        )
        if -best.fun <= TOLERANCE:
            return False
        beyond = hull @ best.x[:-1] - best.x[-1]
        beyond[tried] = -np.inf
        if beyond.max() <= TOLERANCE:
            return True
        worst = _largest(beyond, 4 * len(point))
        tried = np.append(tried, worst[beyond[worst] > TOLERANCE])


def _largest(values: Array, count: int) -> NDArray[np.intp]:
    """Places of the `count` largest values."""
    return np.argpartition(-values, min(count, len(values)) - 1)[:count]


def check(samples: Mapping[str, Samples], seed: int = 0) -> CheckResult:
    """At most one finding, on extrapolation."""
    train = samples[TRAIN].commands
    scale = command_scale(train)
    hull = train[first_of_each(row_groups(train))] / scale
    hull = hull[sampled_rows(len(hull), MAX_HULL, seed)]
    numbers: dict[str, Any] = {"train_commands_looked_at": len(hull)}
    for subset in SUBSETS:
        norms = np.linalg.norm(samples[subset].commands, axis=1)
        numbers[subset] = {"norm_min": float(norms.min()), "norm_max": float(norms.max())}
        if subset == TRAIN:
            continue
        rows = sampled_rows(len(samples[subset]), MAX_ROWS_CHECKED, seed)
        are_off = off_hull(samples[subset].commands[rows] / scale, hull)
        numbers[subset] |= {"rows_looked_at": len(rows), "share_outside_hull": float(are_off.mean())}
    share = numbers[EXTRAPOLATION]["share_outside_hull"]
    if share >= FEWEST_OFF_HULL:
        return CheckResult((), numbers)
    finding = Finding(
        "extrapolation_inside",
        WARNING,
        (EXTRAPOLATION,),
        f"Only {share:.0%} of the checked rows of extrapolation lie outside the convex hull of train commands.",
        "Most of this subset is interpolation: its scores do not tell how a model extrapolates.",
    )
    return CheckResult((finding,), numbers)
