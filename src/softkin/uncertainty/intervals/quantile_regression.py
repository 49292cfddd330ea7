"""Quantile regression: the interval between two predicted quantiles, without calibration."""

from __future__ import annotations

from collections.abc import Sequence

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import QuantileCalibration
from softkin.uncertainty.conformal import uncrossed
from softkin.uncertainty.intervals.spec import NO_GUARANTEE, IntervalMethod


def intervals(data: QuantileCalibration, confidence_levels: Sequence[float]) -> Array:
    """The predicted quantiles at alpha/2 and 1 - alpha/2 of each level; where they cross, in order.

    The levels are among those that quantiles were fitted for. Each quantile has a regressor of its own: an interval of
    a higher level need not contain that of a lower one.
    """
    return uncrossed(data.new[[list(data.levels).index(level) for level in confidence_levels]])


METHOD = IntervalMethod(
    "qr",
    "QR",
    calibrated_on=QuantileCalibration,
    guarantee=NO_GUARANTEE,
    intervals=intervals,
    at_fitted_levels=True,
)
