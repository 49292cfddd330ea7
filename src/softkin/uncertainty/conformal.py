"""Conformal prediction: exact ranks and limits, p-values, and levels that no engine (MAPIE, crepes) rounds wrongly."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import PointCalibration

#: Smallest difficulty, mm: far below the errors of any robot.
TINY = 1e-12


def conformal_rank(n_calibration: int, confidence_level: float) -> int | None:
    """K = ceil(confidence_level (n + 1)), the rank of the score that bounds a new one, in exact arithmetic.

    The level is taken as written in decimals (0.9 is nine tenths). None when k > n: no finite interval has the level.
    Source: Vovk, Gammerman and Shafer (2005); Lei et al. (2018), section 2.2.
    """
    rank = math.ceil(Fraction(str(confidence_level)) * (n_calibration + 1))
    return rank if rank <= n_calibration else None


def conformal_limit(scores: Array, confidence_level: float) -> float:
    """The score (of n) that bounds a new one at the level; infinite when n is too small."""
    rank = conformal_rank(len(scores), confidence_level)
    return float("inf") if rank is None else float(np.sort(scores)[rank - 1])


def conformal_limits(scores: Array, confidence_levels: Sequence[float]) -> Array:
    """As `conformal_limit`, for each level and column of scores (n_rows, n_columns): (n_levels, n_columns)."""
    ordered, ranks = np.sort(scores, axis=0), [conformal_rank(len(scores), level) for level in confidence_levels]
    unknown = np.full(scores.shape[1], np.inf)
    return np.array([unknown if rank is None else ordered[rank - 1] for rank in ranks])


def weighted_limits(scores: Array, weights: Array, own: Array, confidence_levels: Sequence[float]) -> Array:
    """Scores that bound new ones at each level where calibration rows count unequally: (n_levels, n_new, n_columns).

    The weighted quantile of scores (n_rows, n_columns) with weights (n_rows,) and of infinity with the new row's `own`
    weight (n_new,); infinite where the new row outweighs the rest.
    Source: Tibshirani, Barber, Candes and Ramdas (2019), equation 6; Barber et al. (2023), equation 11.
    """
    order = np.argsort(scores, axis=0)
    ordered = np.vstack([np.take_along_axis(scores, order, axis=0), np.full(scores.shape[1], np.inf)])
    sums = np.cumsum(weights[order], axis=0)
    needed = np.outer(confidence_levels, weights.sum() + own) * (1 - 1e-12)  # rounding must not skip an equal sum
    places = [np.searchsorted(column, needed) for column in sums.T]
    return np.stack([column[place] for column, place in zip(ordered.T, places, strict=True)], axis=-1)


def around(predicted: Array, half_widths: Array) -> Array:
    """Intervals (n_levels, n_rows, n_coordinates, 2) around predictions (n_rows, n_coordinates)."""
    return np.stack([predicted - half_widths, predicted + half_widths], axis=-1)


def error_scale(train_errors: Array) -> Array:
    """Typical size (n_columns,) of absolute errors on `train` (n_rows, n_columns): their 90 % quantile, which a few
    gross errors cannot move. 1 for all columns where a model repeats `train` exactly.
    """
    typical = np.quantile(train_errors, 0.9, axis=0)
    largest = float(typical.max())
    return np.maximum(typical, 1e-6 * largest) if largest > 0 else np.ones(train_errors.shape[1])


def joint_scores(residuals: Array, scale: Array) -> Array:
    """Nonconformity of a whole pose (n_rows,): its largest residual (n_rows, n_coordinates) in units of a scale."""
    return np.asarray((np.abs(residuals) / scale).max(axis=1))


def two_sided_rank(n_calibration: int, confidence_level: float) -> int | None:
    """The rank of an interval that leaves out alpha/2 on either side: of n + 1 places those between the two bounds.

    None when either bound is infinite.
    """
    side = conformal_rank(n_calibration, round((1 + confidence_level) / 2, 12))
    return None if side is None else 2 * side - (n_calibration + 1)


def p_values(
    calibration_scores: Array, scores: Array, *, rng: np.random.Generator | None = None, own: int = 1
) -> Array:
    """Conformal p-values (n_rows, ...) of nonconformity `scores` (n_rows, ...), given `calibration_scores` (n, ...).

    The paper's Eq. 4: (number of calibration scores that are at least as large + 1) / (n + 1). With `rng` smoothed:
    scores that are equal count with a uniform random share, so that p-values are exactly uniform (Vovk, Gammerman
    and Shafer 2005, section 2.2).

    Of blocks of `own` rows each, (number + own) / (n + own): the block of a new row is not known and counts in full, as
    in the ranks of `Promise` (Lee, Barber and Willett 2023); its share is not smoothed, and p-values are not too small.
    """
    ordered = np.sort(calibration_scores, axis=0)
    n = len(ordered)
    flat, flat_scores = ordered.reshape(n, -1), scores.reshape(len(scores), -1)
    pairs = list(zip(flat.T, flat_scores.T, strict=True))
    at_least = n - np.column_stack([np.searchsorted(known, new, side="left") for known, new in pairs])
    if rng is None:
        return np.asarray((at_least + own) / (n + own)).reshape(scores.shape)
    above = n - np.column_stack([np.searchsorted(known, new, side="right") for known, new in pairs])
    share = rng.uniform(size=above.shape)
    itself = share if own == 1 else own
    return np.asarray((above + share * (at_least - above) + itself) / (n + own)).reshape(scores.shape)


def unbounded(n_levels: int, shape: tuple[int, ...]) -> Array:
    """Intervals (n_levels, *shape, 2) from minus to plus infinity, as of too small a calibration set."""
    result = np.empty((n_levels, *shape, 2))
    result[..., 0], result[..., 1] = -np.inf, np.inf
    return result


def engine_level(n_calibration: int, rank: int) -> float:
    """A confidence level in the middle of all those with this rank, (k - 1/2) / (n + 1).

    An engine that gets it instead of the nominal level cannot round to a neighbouring rank.
    """
    return (rank - 0.5) / (n_calibration + 1)


def columns(array: Array) -> list[Array]:
    """Columns (n_rows,) of an array (n_rows, n_coordinates): the engines take one coordinate at a time.

    Raises:
        ValueError: not a 2-D array.
    """
    if array.ndim != 2:
        raise ValueError(f"expected (n_rows, n_coordinates), got an array of shape {array.shape}")
    return list(array.T)


def uncrossed(quantiles: Array) -> Array:
    """Quantiles (..., 2) with lower and upper in order: crossed ones are exchanged."""
    return np.sort(quantiles, axis=-1)


def closed(intervals: Array) -> Array:
    """Intervals (..., 2) in which empty ones, lower above upper, are replaced by their middle."""
    result = intervals.copy()
    empty = intervals[..., 0] > intervals[..., 1]
    result[empty] = intervals[empty].mean(axis=-1, keepdims=True)
    return result


def normalised_intervals(
    data: PointCalibration, confidence_levels: Sequence[float], calibration_difficulty: Array, new_difficulty: Array
) -> Array:
    """Split conformal intervals (n_levels, n_new, n_coordinates, 2) whose half-width is proportional to a difficulty.

    Difficulties are (n_rows, n_coordinates) and not negative. One coordinate at a time by crepes.ConformalRegressor;
    infinite where the calibration set is too small.
    """
    from crepes import ConformalRegressor

    n = len(data.truth)
    result = unbounded(len(confidence_levels), data.new.shape)
    for coordinate, residuals in enumerate(columns(data.truth - data.calibration)):
        # A constant coordinate has no spread and no residuals: any difficulty will do.
        known, new = (np.maximum(d[:, coordinate], TINY) for d in (calibration_difficulty, new_difficulty))
        regressor = ConformalRegressor().fit(residuals, sigmas=known)
        for place, level in enumerate(confidence_levels):
            rank = conformal_rank(n, level)
            if rank is not None:
                bounds = regressor.predict_int(data.new[:, coordinate], sigmas=new, confidence=engine_level(n, rank))
                result[place, :, coordinate] = bounds
    return result


def normalised_sides(data: PointCalibration, difficulty: Array, confidence_levels: Sequence[float]) -> Array:
    """Sides (n_levels, n_coordinates, 2) of `normalised_intervals`, in units of the difficulty (n_rows, n_coordinates)
    of the calibration rows.
    """
    scores = np.abs(data.truth - data.calibration) / np.maximum(difficulty, TINY)
    limits = conformal_limits(scores, confidence_levels)
    return np.stack([-limits, limits], axis=-1)


@contextmanager
def global_random_state_kept() -> Iterator[None]:
    """Restore numpy's global random state on exit: engines seed it."""
    state = np.random.get_state()
    try:
        yield
    finally:
        np.random.set_state(state)
