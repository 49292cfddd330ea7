"""Quantile regression: the interval between two predicted quantiles, with nothing to correct it."""

from __future__ import annotations

from collections.abc import Sequence

from softkin.conformal import uncrossed
from softkin.interface import NO_GUARANTEE, Array, Evidence, IntervalMethod


def intervals(evidence: Evidence, confidence_levels: Sequence[float]) -> Array:
    """The predicted quantiles at alpha/2 and 1 - alpha/2 of each level; where they cross, in order.

    Each quantile is learnt by itself, so an interval of a wider level need not contain that of a narrower one.
    """
    return uncrossed(evidence.new)


METHOD = IntervalMethod("qr", "QR", on="quantiles", guarantee=NO_GUARANTEE, intervals=intervals)
