"""MAPIE and a few lines of numpy give the same intervals.

MAPIE called plainly corrects the two sides apart by default, and both sides at another level; the method does not.
"""

from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import QuantileCalibration
from softkin.uncertainty.intervals.conformalized_quantile_regression import ASYMMETRIC, METHOD, intervals
from tests.unit.uncertainty.conftest import LEVELS, quantile_calibration, rank

BASE = 1  # CQR corrects the pair of the level nearest to 0.9


def by_hand(data: QuantileCalibration, symmetric: bool) -> Array:
    n, levels = len(data.truth), []
    for level in LEVELS:
        below = data.calibration[BASE, ..., 0] - data.truth
        above = data.truth - data.calibration[BASE, ..., 1]
        if symmetric:
            low = high = np.sort(np.maximum(below, above), axis=0)[rank(n, level) - 1]
        else:
            k = rank(n, round(1 - (1 - level) / 2, 12))
            low, high = np.sort(below, axis=0)[k - 1], np.sort(above, axis=0)[k - 1]
        levels.append(np.stack([data.new[BASE, ..., 0] - low, data.new[BASE, ..., 1] + high], axis=-1))
    return np.stack(levels)


@pytest.mark.parametrize("n", [88, 140, 395])
@pytest.mark.parametrize("symmetric", [True, False])
def test_intervals_are_romanos(n: int, symmetric: bool) -> None:
    data = quantile_calibration(n)
    bounds = intervals(data, LEVELS, symmetric=symmetric)
    np.testing.assert_allclose(bounds, by_hand(data, symmetric), rtol=0, atol=1e-12)
    method = METHOD if symmetric else ASYMMETRIC
    np.testing.assert_array_equal(method.intervals(data, LEVELS), bounds)


def test_crossed_quantiles_are_put_in_order_before_they_are_corrected() -> None:
    data = quantile_calibration(140)
    crossed = QuantileCalibration(data.calibration[..., ::-1], data.truth, data.new[..., ::-1], LEVELS)
    np.testing.assert_array_equal(intervals(crossed, LEVELS), intervals(data, LEVELS))


def test_quantiles_far_too_wide_are_moved_together_at_most_to_a_point() -> None:
    data = quantile_calibration(88)
    around_truth = data.truth[None, ..., None] + [-50.0, 50.0] + np.zeros((3, 1, 1, 1))
    bounds = intervals(QuantileCalibration(around_truth, data.truth, data.new, LEVELS), LEVELS)
    np.testing.assert_array_equal(bounds[..., 0], bounds[..., 1])
