"""Conformalized quantile regression by MAPIE: predicted quantiles, moved apart (or together) by one number."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.conformal import columns, conformal_rank, engine_level, global_random_state_kept, nested, uncrossed
from softkin.interface import Array, Evidence, IntervalMethod


def intervals(evidence: Evidence, confidence_levels: Sequence[float], *, symmetric: bool = True) -> Array:
    """Romano, Patterson and Candes (2019), Algorithm 1: one correction for both sides, calibrated per coordinate.

    With `symmetric` False each side gets its own correction at half the error (their Theorem 2).
    Source: mapie.regression.ConformalizedQuantileRegressor with fitted quantile models. Its default correction is
    the asymmetric one. Infinite where the calibration set is too small.
    """
    from mapie.regression import ConformalizedQuantileRegressor

    from softkin.estimators.column import Column

    n = len(evidence.truth)
    result = np.empty(evidence.new.shape)
    result[..., 0], result[..., 1] = -np.inf, np.inf
    for place, level in enumerate(confidence_levels):
        side = level if symmetric else 1 - (1 - level) / 2
        rank = conformal_rank(n, round(side, 12))
        if rank is None:
            continue
        exact = engine_level(n, rank)
        lower, upper, new_lower, new_upper = (
            columns(quantiles[place, ..., bound])
            for quantiles in (uncrossed(evidence.calibration), uncrossed(evidence.new))
            for bound in (0, 1)
        )
        for coordinate, true in enumerate(columns(evidence.truth)):
            regressor = ConformalizedQuantileRegressor(
                [Column(0), Column(1), Column(0)],
                confidence_level=exact if symmetric else 2 * exact - 1,
                prefit=True,
            )
            with global_random_state_kept():
                regressor.conformalize(np.column_stack([lower[coordinate], upper[coordinate]]), true)
                _, bounds = regressor.predict_interval(
                    np.column_stack([new_lower[coordinate], new_upper[coordinate]]), symmetric_correction=symmetric
                )
            result[place, :, coordinate] = bounds[..., 0]
    return nested(uncrossed(result))


METHOD = IntervalMethod("cqr", "CQR", on="quantiles", guaranteed=True, intervals=intervals)
