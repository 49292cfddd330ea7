"""Normalised split conformal prediction: wider where the command is far from those of `train`."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, Literal

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import PointCalibration
from softkin.uncertainty.conformal import TINY, conformal_rank, normalised_intervals, normalised_sides
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod, Scaled

NEIGHBOURS = 10
#: The corners of the box of `train` are enumerated in so many dimensions at most.
MOST_COMMANDS = 10
#: Difficulty of a command with `NEIGHBOURS` copies in `train`, in units of that of a typical one.
LEAST_DIFFICULTY = 0.1
#: Results that are kept, of the sets of commands that were asked for last.
MOST_KEPT = 4
#: Content, shape and order in memory of an array of doubles.
_Key = tuple[bytes, tuple[int, ...], Literal["C", "F"]]


def intervals(data: PointCalibration, confidence_levels: Sequence[float]) -> Array:
    """Half-width proportional to a difficulty made from commands alone.

    The difficulty is the mean distance to the nearest commands of `train`; beyond the box of `train` it is the distance
    to that box, plus the difficulty of its emptiest corner. Distances are in standardised command space, in units of
    the mean distance within `train`. It is unbounded and never shrinks along a ray that leaves the box; the distance to
    neighbours alone does where the ray passes some of them. crepes' own estimate from neighbours stops growing at the
    edge of the box (0.9.1, `clip`).
    Source: Papadopoulos, Vovk and Gammerman (2011); crepes.ConformalRegressor with `sigmas`.
    """
    calibration, new = distances(data.train_commands, [data.calibration_commands, data.new_commands])
    shape = (1, data.truth.shape[1])
    return normalised_intervals(
        data, confidence_levels, np.tile(calibration[:, None], shape), np.tile(new[:, None], shape)
    )


def scaled(data: PointCalibration) -> Scaled:
    """The same in plain numbers."""
    (calibration,) = distances(data.train_commands, [data.calibration_commands])
    difficulty = np.tile(calibration[:, None], (1, data.truth.shape[1]))
    numbers, _ = _measured_once(_key(data.train_commands))
    return Scaled(
        lambda confidence_levels: normalised_sides(data, difficulty, confidence_levels),
        {"kind": "distance", "floor": TINY} | numbers,
    )


def distances(train: Array, others: Sequence[Array]) -> list[Array]:
    """Difficulty (n_rows,) of each set of commands in `others`, (n_rows, n_commands) as `train`: of the same commands,
    which all models of a robot share, it is computed once.
    """
    return [_difficulty(_key(train), _key(commands)) for commands in others]


def _key(values: Array) -> _Key:
    """All that an array is."""
    order: Literal["C", "F"] = "F" if values.flags.f_contiguous and not values.flags.c_contiguous else "C"
    return values.tobytes(order), values.shape, order


def _array(key: _Key) -> Array:
    content, shape, order = key
    return np.frombuffer(content).reshape(shape, order=order)


@lru_cache(MOST_KEPT)
def _difficulty(train: _Key, others: _Key) -> Array:
    """`distances` of one set of commands, which nobody may write to."""
    numbers, finder = _measured_once(train)
    rows = (_array(others) - numbers["mean"]) / numbers["scale"]
    beyond = np.linalg.norm(rows - np.clip(rows, numbers["low"], numbers["high"]), axis=1)
    near = np.minimum(finder.kneighbors(rows)[0].mean(axis=1), numbers["emptiest"])
    far = np.where(beyond > 0, numbers["emptiest"] + beyond, near)
    difficulty = LEAST_DIFFICULTY + far / numbers["unit"]
    difficulty.flags.writeable = False
    return np.asarray(difficulty)


@lru_cache(MOST_KEPT)
def _measured_once(train: _Key) -> tuple[dict[str, Any], Any]:
    return _measured(_array(train))


def _measured(train: Array) -> tuple[dict[str, Any], Any]:
    """What distances are measured by, and what finds neighbours among the standardised commands of `train`."""
    from sklearn.neighbors import NearestNeighbors
    from sklearn.preprocessing import StandardScaler

    scaler = StandardScaler().fit(train)
    known = scaler.transform(train)
    neighbours = min(NEIGHBOURS, len(train) - 1)
    finder = NearestNeighbors(n_neighbors=neighbours).fit(known)
    within = float(finder.kneighbors()[0].mean())
    low, high = known.min(axis=0), known.max(axis=0)
    return {
        "mean": scaler.mean_,
        "scale": scaler.scale_,
        "points": known,
        "neighbours": neighbours,
        "unit": within if within > 0 else 1.0,  # 0: each command has many copies
        "low": low,
        "high": high,
        "emptiest": float(finder.kneighbors(_corners(low, high))[0].mean(axis=1).max()),
        "least": LEAST_DIFFICULTY,
    }, finder


def _corners(low: Array, high: Array) -> Array:
    """Corners (n_corners, n_commands) of a box, of which at most `MOST_COMMANDS` dimensions vary."""
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
    scaled=scaled,
)
