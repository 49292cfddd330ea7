"""What an interval promises: of rows that are exchangeable, or of blocks of a recording that are.

Where a table is split by stretches of time or by groups, blocks were drawn at random and not rows: a row is like the
rows of its block, and only blocks are exchangeable. Hierarchical conformal prediction (Lee, Barber and Willett 2023;
one row per block: Dunn, Wasserman and Ramdas 2022) then gives every held-out block the same weight and counts blocks:
with K of them an interval at level c reaches to the score of rank ceil(c (K + 1) M) among K blocks of M rows, and holds
a row of a new block with probability c. There is such a rank where c is at most K / (K + 1).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array, Samples
from softkin.uncertainty.conformal import engine_level, two_sided_rank
from softkin.uncertainty.intervals.spec import MARGINAL, NO_GUARANTEE, IntervalMethod, Scaled

#: Guarantee of an interval that is calibrated on blocks: marginal coverage of a row of a new block.
BY_BLOCK = "marginal, by block"
#: With more calibration rows than this each block gives fewer.
MAX_ROWS = 20_000


@dataclass(frozen=True, slots=True)
class Promise:
    """A calibration set of `n_blocks` blocks with `n_rows` rows of each."""

    n_blocks: int
    n_rows: int

    def holds(self, level: float, two_sided: bool = False) -> bool:
        """Whether an interval of the level can be promised; `two_sided`: each bound at half the miscoverage."""
        return self._rank(level, two_sided) <= self.n_blocks * self.n_rows

    def asked(self, level: float, two_sided: bool = False) -> float:
        """The level that a method which counts rows is asked for: the level of the promise; where there is none the
        highest that is finite, and of a single block, such as the future, the level itself.
        """
        if self.n_blocks == 1:
            return level
        n = self.n_blocks * self.n_rows
        share = engine_level(n, min(self._rank(level, two_sided), n))
        return 2 * share - 1 if two_sided else share

    def guarantee(self, method: IntervalMethod[Any], level: float) -> str:
        """What an interval by a method that promises `method.guarantee` of rows promises here."""
        if method.guarantee != MARGINAL or method.calibrated_on.needs_refits:
            return NO_GUARANTEE
        return BY_BLOCK if self.holds(level, method.rank is two_sided_rank) else self._nothing()

    def of_region(self, guarantee: str, level: float) -> str:
        """What a joint region of the level promises, which promises `guarantee` where rows are exchangeable."""
        return f"{guarantee}, by block" if self.holds(level) else self._nothing()

    def _nothing(self) -> str:
        return f"{NO_GUARANTEE} ({self.n_blocks} block{'s' * (self.n_blocks != 1)})"

    def _rank(self, level: float, two_sided: bool) -> int:
        exact = Fraction(str(level))
        side = (1 + exact) / 2 if two_sided else exact
        return math.ceil(side * (self.n_blocks + 1) * self.n_rows)


def own_rows(promise: Promise | None, level: float = 0.9) -> int:
    """As how many rows a new one counts in its p-value: those of a block where blocks are enough for the level, else
    one, and where there is a promise of blocks nothing is then promised.
    """
    return promise.n_rows if promise is not None and promise.holds(level) else 1


def worth_of_p_values(promise: Promise | None, level: float = 0.9) -> str:
    """What p-values are worth where rows are not exchangeable, in a sentence; empty where they are."""
    if promise is None:
        return ""
    if promise.holds(level):
        return (
            f"P-values count the {promise.n_blocks} blocks of rows that the model was calibrated on: they hold for a "
            "pose of a new block (a stretch of time, a trial), and not for its poses one by one, which are alike."
        )
    blocks = f"{promise.n_blocks} block{'s' * (promise.n_blocks != 1)} of rows"
    return f"P-values have {NO_GUARANTEE}: they count rows, and the model was calibrated on {blocks}, which is too few."


def worth_of_alarm(promise: Promise | None) -> str:
    """What the rate of false alarms is worth where rows are not exchangeable; empty where they are."""
    if promise is None:
        return ""
    return (
        f"The rate of false alarms has {NO_GUARANTEE}: it takes poses that are exchangeable one by one, and those of a "
        "recording come in blocks whose poses are alike, so that a new block can raise an alarm by itself."
    )


def calibration_rows(block: NDArray[np.int64], seed: int = 0) -> tuple[NDArray[np.intp], Promise]:
    """Row numbers (n_blocks * n_rows,) with which each block counts alike, and what they promise.

    Each block gives as many rows as the largest has: all its rows equally often, the rest drawn without replacement.
    """
    codes, counts = np.unique(block, return_inverse=True, return_counts=True)[1:]
    n_rows = int(min(counts.max(), max(1, MAX_ROWS // len(counts))))
    rng = np.random.default_rng(seed)
    rows = []
    in_blocks = np.split(np.argsort(codes, kind="stable"), np.cumsum(counts)[:-1])
    for own, count in zip(in_blocks, counts, strict=True):
        rows += [np.tile(own, n_rows // count), rng.permutation(own)[: n_rows % count]]
    return np.concatenate(rows).astype(np.intp), Promise(len(counts), n_rows)


def calibration_set(validation: Samples) -> tuple[Samples, NDArray[np.intp], Promise | None]:
    """The calibration set that `validation` makes, its row numbers there, and the promise; None where rows, and not
    blocks, are exchangeable.
    """
    if validation.block is None:
        return validation, np.arange(len(validation)), None
    rows, promise = calibration_rows(validation.block)
    return validation.take(rows), rows, promise


def asked_levels(
    promise: Promise | None, confidence_levels: Sequence[float], two_sided: bool = False
) -> tuple[float, ...]:
    """The levels that what counts rows is asked for, as `Promise.asked`; where rows are exchangeable the same."""
    if promise is None:
        return tuple(confidence_levels)
    return tuple(promise.asked(level, two_sided) for level in confidence_levels)


def promised(method: IntervalMethod[Any], promise: Promise | None, level: float = 0.9) -> IntervalMethod[Any]:
    """The method, its levels asked for as the promise needs; its `guarantee` is that at `level`. A method that is
    calibrated on no row of `validation` stays.
    """
    if promise is None:
        return method
    guarantee = promise.guarantee(method, level)
    if method.guarantee != MARGINAL or method.calibrated_on.needs_refits:
        return replace(method, guarantee=guarantee)
    two_sided = method.rank is two_sided_rank
    asked = partial(_asked, method.intervals, promise, two_sided)
    scaled = None if method.scaled is None else partial(_scaled, method.scaled, promise, two_sided)
    return replace(method, intervals=asked, scaled=scaled, guarantee=guarantee)


def promised_methods(
    methods: Mapping[str, IntervalMethod[Any]], promise: Promise | None
) -> dict[str, IntervalMethod[Any]]:
    """Interval methods by name, each as `promised`."""
    return {name: promised(method, promise) for name, method in methods.items()}


def _asked(
    intervals: Callable[[Any, Sequence[float]], Array],
    promise: Promise,
    two_sided: bool,
    data: Any,
    confidence_levels: Sequence[float],
) -> Array:
    """Intervals (n_levels, n_rows, n_coordinates, 2) at the levels that the promise asks for."""
    if data.is_for_extrapolation:  # its in-domain bounds are there for each level
        return intervals(data, asked_levels(promise, confidence_levels, two_sided))
    return _each_once(partial(intervals, data), promise, two_sided, confidence_levels)


def _scaled(scaled: Callable[[Any], Scaled], promise: Promise, two_sided: bool, data: Any) -> Scaled:
    """The same in plain numbers, with the sides of the levels that the promise asks for."""
    by_row = scaled(data)
    return replace(by_row, sides=partial(_each_once, by_row.sides, promise, two_sided))


def _each_once(
    bounds: Callable[[Sequence[float]], Array], promise: Promise, two_sided: bool, confidence_levels: Sequence[float]
) -> Array:
    """Bounds (n_levels, ...) at the levels that the promise asks for, each of which is worked out once."""
    asked = asked_levels(promise, confidence_levels, two_sided)
    distinct = sorted(set(asked))
    return np.asarray(bounds(distinct)[[distinct.index(level) for level in asked]])
