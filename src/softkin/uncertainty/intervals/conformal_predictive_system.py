"""Conformal predictive system by crepes: intervals between two quantiles of a predictive distribution."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import PointCalibration
from softkin.uncertainty.conformal import columns, conformal_rank, two_sided_rank, unbounded
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod, as_at_zero


def intervals(data: PointCalibration, confidence_levels: Sequence[float]) -> Array:
    """From the alpha/2 to the 1 - alpha/2 quantile of the distribution, one coordinate at a time.

    The distribution is the prediction plus the signed residuals of the calibration set, so an interval need not lie
    evenly around the prediction. Infinite where the calibration set is too small for a side.
    Source: crepes.ConformalPredictiveSystem (Vovk, Shen, Manokhin and Xie 2019), lower percentile rounded down and
    upper one up.
    """
    from crepes import ConformalPredictiveSystem

    n = len(data.truth)
    result = unbounded(len(confidence_levels), data.new.shape)
    ranks = [conformal_rank(n, round((1 + level) / 2, 12)) for level in confidence_levels]
    finite = {place: (rank - 0.5) / (n + 1) for place, rank in enumerate(ranks) if rank is not None}
    if not finite:
        return result
    upper = [100 * share for share in finite.values()]
    lower = [100 * (1 - share) for share in finite.values()]
    together = zip(columns(data.calibration), columns(data.truth), columns(data.new), strict=True)
    for coordinate, (predicted, true, new) in enumerate(together):
        system = ConformalPredictiveSystem().fit(true - predicted)
        bounds = system.predict_percentiles(new, lower_percentiles=lower, higher_percentiles=upper)
        bounds = np.asarray(bounds).reshape(len(new), 2, len(finite))
        result[list(finite), :, coordinate] = np.moveaxis(bounds, 2, 0)
    return result


def crps(data: PointCalibration, true: Array) -> Array:
    """Continuous ranked probability score (n_rows, n_coordinates) in mm of the distribution at the `new` rows.

    E|X - x| - E|X - X'|/2 over the residuals (Gneiting and Raftery 2007, equation 21). crepes has it too, but
    multiplies by the difficulty twice where there is one (0.9.1), and takes a row at a time.
    """
    result = np.empty(true.shape)
    for coordinate, residuals in enumerate(columns(data.truth - data.calibration)):
        ordered = np.sort(residuals)
        n = len(ordered)
        sums = np.concatenate([[0.0], np.cumsum(ordered)])
        errors = true[:, coordinate] - data.new[:, coordinate]
        below = np.searchsorted(ordered, errors)
        distance = errors * (2 * below - n) + sums[n] - 2 * sums[below]
        pairs = 2 * np.sum((2 * np.arange(n) - n + 1) * ordered)
        result[:, coordinate] = distance / n - pairs / (2 * n * n)
    return result


METHOD = IntervalMethod(
    "cps",
    "Conformal predictive system",
    calibrated_on=PointCalibration,
    guarantee=MARGINAL,
    intervals=intervals,
    rank=two_sided_rank,
    crps=crps,
    scaled=partial(as_at_zero, intervals),
)
