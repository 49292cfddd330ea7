"""What every conformal method needs: the exact rank, and a level that no engine can round wrongly."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction

import numpy as np

from softkin.interface import Array


def conformal_rank(n_calibration: int, confidence_level: float) -> int | None:
    """K = ceil(confidence_level (n + 1)), the rank of the score that bounds a new one, in exact arithmetic.

    The level is taken as written in decimals (0.9 is nine tenths). None when k > n: no finite interval has the level.
    Source: Vovk, Gammerman and Shafer (2005); Lei et al. (2018), section 2.2.
    """
    rank = math.ceil(Fraction(str(confidence_level)) * (n_calibration + 1))
    return rank if rank <= n_calibration else None


def engine_level(n_calibration: int, rank: int) -> float:
    """A confidence level in the middle of all those with this rank, (k - 1/2) / (n + 1).

    Handed to an engine instead of the nominal one, its own arithmetic cannot fall on the wrong side of an integer.
    """
    return (rank - 0.5) / (n_calibration + 1)


def columns(array: Array) -> list[Array]:
    """The coordinates of (n_rows, n_coordinates) one by one: the engines are 1-D.

    Raises:
        ValueError: not a 2-D array.
    """
    if array.ndim != 2:
        raise ValueError(f"expected (n_rows, n_coordinates), got an array of shape {array.shape}")
    return list(array.T)


def uncrossed(quantiles: Array) -> Array:
    """Quantiles (..., 2) with lower and upper in order: where two predicted quantiles cross, they are exchanged."""
    return np.sort(quantiles, axis=-1)


def closed(intervals: Array) -> Array:
    """Intervals (..., 2) with an empty one, lower above upper, closed to its middle."""
    result = intervals.copy()
    empty = intervals[..., 0] > intervals[..., 1]
    result[empty] = intervals[empty].mean(axis=-1, keepdims=True)
    return result


@contextmanager
def global_random_state_kept() -> Iterator[None]:
    """Leave numpy's global random state as it was: engines seed it."""
    state = np.random.get_state()
    try:
        yield
    finally:
        np.random.set_state(state)
