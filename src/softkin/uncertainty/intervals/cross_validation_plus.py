"""CV+: each row of `train` is scored by the refit that holds it out; no calibration set is needed."""

from __future__ import annotations

from collections.abc import Sequence

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import FoldCalibration
from softkin.uncertainty.intervals.spec import WEAK, IntervalMethod
from softkin.uncertainty.refit_bounds import plus_intervals


def intervals(data: FoldCalibration, confidence_levels: Sequence[float]) -> Array:
    """Barber, Candes, Ramdas and Tibshirani (2021), section 3, one coordinate at a time, folds grouped by command.

    Its coverage is at least 1 - 2 alpha, in practice about 1 - alpha. Infinite where `train` is too small.
    Source: mapie.regression.CrossConformalRegressor with the method `plus`, whose bounds these are.
    """
    return plus_intervals(data, confidence_levels)


METHOD = IntervalMethod("cv_plus", "CV+", calibrated_on=FoldCalibration, guarantee=WEAK, intervals=intervals)
