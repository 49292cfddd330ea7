"""Split conformal prediction by crepes: the standard conformal regressor."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import PointCalibration
from softkin.uncertainty.conformal import columns, conformal_rank, engine_level, unbounded
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod, as_at_zero


def intervals(data: PointCalibration, confidence_levels: Sequence[float]) -> Array:
    """The paper's Eq. 5 and 6, one coordinate at a time; infinite where the calibration set is too small.

    Source: crepes.ConformalRegressor without difficulty and bins. Its own rank is one too large at 0.9 for n = 9 mod
    10 (0.9.1, floating point), hence the level from the exact rank.
    """
    from crepes import ConformalRegressor

    n = len(data.truth)
    result = unbounded(len(confidence_levels), data.new.shape)
    together = zip(columns(data.calibration), columns(data.truth), columns(data.new), strict=True)
    for coordinate, (predicted, true, new) in enumerate(together):
        regressor = ConformalRegressor().fit(true - predicted)
        for place, level in enumerate(confidence_levels):
            rank = conformal_rank(n, level)
            if rank is not None:
                bounds = regressor.predict_int(new, confidence=engine_level(n, rank))
                result[place, :, coordinate] = bounds
    return result


METHOD = IntervalMethod(
    "scp_crepes",
    "SCP (crepes)",
    calibrated_on=PointCalibration,
    guarantee=MARGINAL,
    intervals=intervals,
    rank=conformal_rank,
    has_constant_width=True,
    scaled=partial(as_at_zero, intervals),
)
