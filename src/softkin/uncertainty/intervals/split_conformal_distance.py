"""Normalised split conformal prediction: wider where the command lies far from those that were trained on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import PointCalibration
from softkin.uncertainty.conformal import conformal_rank, normalised_intervals
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod

NEIGHBOURS = 10
#: Of a box of more commands than this, as many corners are looked at as one of this many has.
MOST_COMMANDS = 10
#: Difficulty of a command that stands in `train` many times over, where 1 is that of a typical one.
LEAST_DIFFICULTY = 0.1


def intervals(data: PointCalibration, confidence_levels: Sequence[float]) -> Array:
    """Half-width proportional to a difficulty that knows no truth: the mean distance to the nearest train commands,
    and outside the box of `train` the distance to that box, on top of what its emptiest corner has.

    In standardised command space, in units of the mean distance within `train`. It grows without end, and never
    shrinks along a ray that leaves the box: the distance to neighbours alone does, where the ray passes some of them.
    Not crepes' own estimate from neighbours, which stops growing at the edge of the box (0.9.1, `clip`).
    Source: Papadopoulos, Vovk and Gammerman (2011); crepes.ConformalRegressor with `sigmas`.
    """
    calibration, new = distances(data.train_commands, [data.calibration_commands, data.new_commands])
    shape = (1, data.truth.shape[1])
    return normalised_intervals(
        data, confidence_levels, np.tile(calibration[:, None], shape), np.tile(new[:, None], shape)
    )


def distances(train: Array, others: Sequence[Array]) -> list[Array]:
    """Difficulty (n_rows,) of each set of commands."""
    from sklearn.neighbors import NearestNeighbors
    from sklearn.preprocessing import StandardScaler

    scaler = StandardScaler().fit(train)
    known = scaler.transform(train)
    finder = NearestNeighbors(n_neighbors=min(NEIGHBOURS, len(train) - 1)).fit(known)
    within = float(finder.kneighbors()[0].mean())
    unit = within if within > 0 else 1.0  # every command many times over
    low, high = known.min(axis=0), known.max(axis=0)
    emptiest = float(finder.kneighbors(_corners(low, high))[0].mean(axis=1).max())
    found = []
    for rows in map(scaler.transform, others):
        beyond = np.linalg.norm(rows - np.clip(rows, low, high), axis=1)
        near = np.minimum(finder.kneighbors(rows)[0].mean(axis=1), emptiest)
        found.append(LEAST_DIFFICULTY + np.where(beyond > 0, emptiest + beyond, near) / unit)
    return found


def _corners(low: Array, high: Array) -> Array:
    """Corners (n_corners, n_commands) of a box; of one of many commands those that differ in the first few."""
    n = min(len(low), MOST_COMMANDS)
    is_high = np.zeros((2**n, len(low)), dtype=bool)
    is_high[:, :n] = np.arange(2**n)[:, None] >> np.arange(n) & 1
    return np.where(is_high, high, low)


METHOD = IntervalMethod(
    "scp_distance",
    "SCP, by distance",
    calibrated_on=PointCalibration,
    guarantee=MARGINAL,
    intervals=intervals,
    rank=conformal_rank,
)
