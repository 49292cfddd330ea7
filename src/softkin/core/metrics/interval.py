"""Interval metrics. Intervals are (n_rows, n_coordinates, 2), truth is (n_rows, n_coordinates), in mm."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array


def covered(true: Array, intervals: Array) -> NDArray[np.bool_]:
    """Whether lower <= x <= upper, (n_rows, n_coordinates)."""
    return np.asarray((intervals[..., 0] <= true) & (true <= intervals[..., 1]))


def widths(intervals: Array) -> Array:
    """Upper - lower, (n_rows, n_coordinates); mm."""
    return np.asarray(intervals[..., 1] - intervals[..., 0])


def geometric_size(width: Array) -> Array:
    """Side (..., n_rows) of the cube whose volume is that of the box with these widths (..., n_rows, n_coordinates);
    mm.
    """
    return np.asarray(np.exp(np.log(np.maximum(width, np.finfo(float).tiny)).mean(axis=-1)))


def winkler_scores(true: Array, intervals: Array, confidence_level: float) -> Array:
    """Winkler (1972) interval scores (n_rows, n_coordinates), the paper's formula; mm.

    Width, plus 2/alpha times the distance by which the interval misses. For a symmetric interval of constant width
    the mean is at least twice the mean absolute error of its centre.
    """
    alpha = 1.0 - confidence_level
    below = np.maximum(intervals[..., 0] - true, 0.0)
    above = np.maximum(true - intervals[..., 1], 0.0)
    return np.asarray(widths(intervals) + 2.0 / alpha * (below + above))


#: A Winkler score below this (mm) counts as this in a typical one, whose logarithm has no bound at 0.
TINY_MM = 1e-12


def typical_winkler(row_scores: Array) -> float:
    """The typical Winkler score of rows: the geometric mean of their scores (n_rows,), mm.

    The mean of logarithms: a row counts by the factor, not by the millimetres, by which an interval method does better
    or worse on it, so that a handful of gross errors cannot decide between two methods. Infinite where a score is.
    """
    return float(np.exp(np.log(np.maximum(row_scores, TINY_MM)).mean()))


@cache
def coverage_band(n_rows: int, n_calibration: int, rank: int, band: float = 0.95) -> tuple[float, float]:
    """Exact central band of the coverage of `n_rows` new rows of a conformal interval of this rank.

    The number of covered rows is beta-binomial(n_rows, k, n + 1 - k) when calibration and new rows are exchangeable
    and scores have no ties (Vovk 2012; Angelopoulos and Bates 2023, section 3.2).
    """
    from scipy import stats

    law = stats.betabinom(n_rows, rank, n_calibration + 1 - rank)
    tail = (1.0 - band) / 2
    return float(law.ppf(tail)) / n_rows, float(law.ppf(1.0 - tail)) / n_rows


@cache
def coverage_p_value(n_covered: int, n_rows: int, n_calibration: int, rank: int) -> float:
    """Two-sided exact p-value of this many covered rows, under the beta-binomial distribution of `coverage_band`."""
    from scipy import stats

    law = stats.betabinom(n_rows, rank, n_calibration + 1 - rank)
    return float(min(1.0, 2.0 * min(law.cdf(n_covered), law.sf(n_covered - 1))))


@cache
def clopper_pearson(n_covered: int, n_rows: int, band: float = 0.95) -> tuple[float, float]:
    """Exact binomial confidence interval of a coverage (Clopper and Pearson 1934).

    Its ends are quantiles of beta distributions; scipy's binomtest searches for them, a thousand times slower.
    """
    from scipy import special

    tail, missed = (1.0 - band) / 2, n_rows - n_covered
    low = special.betaincinv(n_covered, missed + 1, tail) if n_covered else 0.0
    high = special.betaincinv(n_covered + 1, missed, 1.0 - tail) if missed else 1.0
    return float(low), float(high)


def fewest_commands(confidence_level: float, error: float = 0.05) -> int:
    """How many distinct commands can tell a coverage at all: 29 at 90 %.

    Had fewer been drawn and all been covered, a coverage below the level would still not be excluded at this `error`.
    """
    return int(np.ceil(np.log(error) / np.log(confidence_level) - 1e-9))


def holm(p_values: Array) -> Array:
    """Holm's (1979) adjusted p-values: rejecting those at most alpha keeps the family-wise error rate at alpha."""
    order = np.argsort(p_values, kind="stable")
    factors = np.arange(len(p_values), 0, -1)
    adjusted = np.empty(len(p_values))
    adjusted[order] = np.minimum(1.0, np.maximum.accumulate(factors * p_values[order]))
    return adjusted


def worst_slab(
    commands: Array, covered_share: Array, seed: int, share: float = 0.2, n_directions: int = 200
) -> NDArray[np.intp]:
    """Row numbers of the slab a <= v'u <= b of command space with the lowest coverage.

    The slab is searched on a random half of the rows, and its rows are those of the other half, so that picking the
    worst of many slabs does not bias its coverage.
    Source: Cauchois, Gupta and Duchi (2021), section 4; Romano, Sesia and Candes (2020).

    Parameters:
        commands: (n_rows, n_commands).
        covered_share: share of covered coordinates of each row (n_rows,).
        seed: of the halves and of the directions v.
        share: least share of the searched rows that a slab holds.
        n_directions: number of random directions v.
    """
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(commands))
    search, rest = np.array_split(order, 2)
    scale = commands.std(axis=0)
    standardised = (commands - commands.mean(axis=0)) / np.where(scale > 0, scale, 1.0)
    least = max(1, int(np.ceil(share * len(search))))
    worst, slab = np.inf, (np.zeros(commands.shape[1]), -np.inf, np.inf)
    for direction in rng.standard_normal((n_directions, commands.shape[1])):
        values = standardised[search] @ direction
        ranked = np.argsort(values, kind="stable")
        sums = np.concatenate([[0.0], np.cumsum(covered_share[search][ranked])])
        for length in (least, (least + len(search)) // 2):
            means = (sums[length:] - sums[:-length]) / length
            start = int(np.argmin(means))
            if means[start] < worst:
                ends = values[ranked[[start, start + length - 1]]]
                worst, slab = float(means[start]), (direction, float(ends[0]), float(ends[1]))
    direction, low, high = slab
    values = standardised[rest] @ direction
    return np.asarray(rest[(low <= values) & (values <= high)])
