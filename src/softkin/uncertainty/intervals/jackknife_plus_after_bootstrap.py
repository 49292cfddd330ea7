"""Jackknife+-after-bootstrap: each row of `train` is scored by the refits that hold it out."""

from __future__ import annotations

from collections.abc import Sequence

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import ResampleCalibration
from softkin.uncertainty.intervals.spec import WEAK, IntervalMethod
from softkin.uncertainty.refit_bounds import plus_intervals


def intervals(data: ResampleCalibration, confidence_levels: Sequence[float]) -> Array:
    """Kim, Xu and Barber (2020), one coordinate at a time, predictions averaged over refits.

    The interval goes around the average of the refits, not around the model fitted on all rows. Its coverage is at
    least 1 - 2 alpha, in practice about 1 - alpha. Infinite where `train` is too small.
    Source: mapie.regression.JackknifeAfterBootstrapRegressor with the method `plus`, whose bounds these are.
    """
    return plus_intervals(data, confidence_levels)


METHOD = IntervalMethod(
    "jackknife_plus_ab",
    "Jackknife+-after-bootstrap",
    calibrated_on=ResampleCalibration,
    guarantee=WEAK,
    intervals=intervals,
)
