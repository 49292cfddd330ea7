"""Verdicts on a printed number of the paper: whether a measured one reproduces it to its last digit."""

from __future__ import annotations

from decimal import Decimal

from softkin.core.metrics.point import LARGER_IS_BETTER

REPRODUCED, BETTER, WORSE = ("reproduced", "better", "worse")


def unit(printed: str) -> float:
    """One unit of the last printed digit: 0.01 of '2.89', 1e-5 of '5.57e-3'."""
    exponent = Decimal(printed).as_tuple().exponent
    assert isinstance(exponent, int)  # a finite number, not NaN or infinity
    return float(Decimal(1).scaleb(exponent))


def verdict(printed: str, ours: float, metric: str) -> str:
    """`reproduced` when `ours` lies within one unit of the last printed digit (the paper truncates as often as it
    rounds), else `better` or `worse`.
    """
    difference = ours - float(printed)
    if abs(difference) <= unit(printed) * (1 + 1e-9):
        return REPRODUCED
    return BETTER if (difference > 0) == LARGER_IS_BETTER[metric] else WORSE
