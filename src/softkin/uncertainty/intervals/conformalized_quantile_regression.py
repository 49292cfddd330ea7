"""Conformalized quantile regression (CQR) by MAPIE: predicted quantiles, moved apart or together by one number."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.runs import nearest_level
from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import QuantileCalibration
from softkin.uncertainty.conformal import (
    closed,
    columns,
    conformal_rank,
    engine_level,
    global_random_state_kept,
    two_sided_rank,
    unbounded,
    uncrossed,
)
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod


def intervals(data: QuantileCalibration, confidence_levels: Sequence[float], *, symmetric: bool = True) -> Array:
    """Romano, Patterson and Candes (2019), Algorithm 1: one correction for both sides, calibrated per coordinate.

    All levels use the scores of one pair of quantiles, each its own rank of them, so that intervals of higher levels
    contain those of lower ones. With `symmetric` False each side has its own correction at half the miscoverage (their
    Theorem 2).
    Source: mapie.regression.ConformalizedQuantileRegressor with fitted quantile models. Its default correction is
    the asymmetric one. Infinite where the calibration set is too small.
    """
    from mapie.regression import ConformalizedQuantileRegressor

    from softkin.models.estimators.column import Column

    n = len(data.truth)
    result = unbounded(len(confidence_levels), data.new.shape[1:-1])
    # The corrected pair of quantiles is that of the level nearest to the paper's.
    base = list(data.levels).index(nearest_level(data.levels))
    pairs, new_pairs = (_with_middle(uncrossed(quantiles[base])) for quantiles in (data.calibration, data.new))
    for place, level in enumerate(confidence_levels):
        side = level if symmetric else round(1 - (1 - level) / 2, 12)
        rank = conformal_rank(n, side)
        if rank is None:
            continue
        exact = engine_level(n, rank)
        for coordinate, true in enumerate(columns(data.truth)):
            regressor = ConformalizedQuantileRegressor(
                [Column(0), Column(1), Column(2)],
                confidence_level=exact if symmetric else 2 * exact - 1,
                prefit=True,
            )
            with global_random_state_kept():
                regressor.conformalize(pairs[:, coordinate], true)
                _, bounds = regressor.predict_interval(new_pairs[:, coordinate], symmetric_correction=symmetric)
            result[place, :, coordinate] = bounds[..., 0]
    return closed(result)


def _with_middle(pairs: Array) -> Array:
    """Pairs of quantiles with their middle (..., 3), which MAPIE needs as a point prediction: lower, upper, middle."""
    return np.concatenate([pairs, pairs.mean(axis=-1, keepdims=True)], axis=-1)


def asymmetric_intervals(data: QuantileCalibration, confidence_levels: Sequence[float]) -> Array:
    """As `intervals`, with a correction for each side, at half the miscoverage."""
    return intervals(data, confidence_levels, symmetric=False)


METHOD = IntervalMethod(
    "cqr", "CQR", calibrated_on=QuantileCalibration, guarantee=MARGINAL, intervals=intervals, rank=conformal_rank
)
ASYMMETRIC = IntervalMethod(
    "cqr_asymmetric",
    "CQR, asymmetric",
    calibrated_on=QuantileCalibration,
    guarantee=MARGINAL,
    intervals=asymmetric_intervals,
    rank=two_sided_rank,
)
