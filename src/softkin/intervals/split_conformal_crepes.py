"""Split conformal prediction by crepes: the standard conformal regressor."""

from __future__ import annotations

from collections.abc import Sequence

from softkin.conformal import columns, conformal_rank, engine_level, unbounded
from softkin.interface import MARGINAL, Array, Evidence, IntervalMethod


def intervals(evidence: Evidence, confidence_levels: Sequence[float]) -> Array:
    """The paper's Eq. 5 and 6, one coordinate at a time; infinite where the calibration set is too small.

    Source: crepes.ConformalRegressor without difficulty and bins. Its own rank is one too wide at 0.9 for n = 9 mod
    10 (0.9.1, floating point), hence the level from the exact rank.
    """
    from crepes import ConformalRegressor

    n = len(evidence.truth)
    result = unbounded(len(confidence_levels), evidence.new.shape)
    together = zip(columns(evidence.calibration), columns(evidence.truth), columns(evidence.new), strict=True)
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
    on="predictions",
    guarantee=MARGINAL,
    intervals=intervals,
    rank=conformal_rank,
    has_constant_width=True,
)
