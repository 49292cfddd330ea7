"""Split conformal prediction by MAPIE: predicted position plus or minus a quantile of the absolute residuals."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from softkin.core.errors import ConfigError
from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import PointCalibration
from softkin.uncertainty.conformal import columns, conformal_rank, engine_level, global_random_state_kept, unbounded
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod, as_at_zero


def intervals(data: PointCalibration, confidence_levels: Sequence[float]) -> Array:
    """The paper's Eq. 5 and 6, one coordinate at a time; infinite where the calibration set is too small.

    Raises:
        ConfigError: a level so low that the smallest of all errors has it.

    Source: mapie.regression.SplitConformalRegressor with the score `absolute` and a fitted model.
    """
    from mapie.regression import SplitConformalRegressor

    from softkin.models.estimators.column import Column

    n = len(data.truth)
    result = unbounded(len(confidence_levels), data.new.shape)
    ranks = {place: conformal_rank(n, level) for place, level in enumerate(confidence_levels)}
    if 1 in ranks.values():
        raise ConfigError(
            f"confidence level {confidence_levels[0]:g} is less than MAPIE takes of {n} calibration rows",
            where="scp_mapie",
            fix=f"ask for more than {1 / (n + 1):.2g}, or choose scp_crepes",
        )
    finite = {place: engine_level(n, rank) for place, rank in ranks.items() if rank is not None}
    if not finite:
        return result
    together = zip(columns(data.calibration), columns(data.truth), columns(data.new), strict=True)
    for coordinate, (predicted, true, new) in enumerate(together):
        regressor = SplitConformalRegressor(
            Column(0), confidence_level=list(finite.values()), conformity_score="absolute", prefit=True
        )
        with global_random_state_kept():
            regressor.conformalize(predicted[:, None], true)
            _, bounds = regressor.predict_interval(new[:, None])
        result[list(finite), :, coordinate] = np.moveaxis(bounds, 2, 0)
    return result


METHOD = IntervalMethod(
    "scp_mapie",
    "SCP (MAPIE)",
    calibrated_on=PointCalibration,
    guarantee=MARGINAL,
    intervals=intervals,
    rank=conformal_rank,
    has_constant_width=True,
    scaled=partial(as_at_zero, intervals),
)
