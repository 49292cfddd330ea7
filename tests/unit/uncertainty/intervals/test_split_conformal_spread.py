from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from softkin.uncertainty.intervals.split_conformal_spread import LEAST_SHARE, intervals
from tests.unit.uncertainty.conftest import LEVELS, rank, spread_calibration


@pytest.mark.parametrize("n", [88, 140, 395])
def test_a_difficulty_scales_the_half_width(n: int) -> None:
    data = spread_calibration(n)
    least = 0.1 * data.train_spread.mean(axis=0)
    scores = np.sort(np.abs(data.truth - data.calibration) / (data.calibration_spread + least), axis=0)
    bounds = intervals(data, LEVELS)
    for place, level in enumerate(LEVELS):
        half = scores[rank(n, level) - 1] * (data.new_spread + least)
        expected = np.stack([data.new - half, data.new + half], axis=-1)
        np.testing.assert_allclose(bounds[place], expected, rtol=0, atol=1e-10)


def test_a_spread_of_zero_keeps_some_width() -> None:
    data = spread_calibration(88)
    sure, plain = intervals(replace(data, new_spread=np.zeros_like(data.new_spread)), LEVELS), intervals(data, LEVELS)
    least = LEAST_SHARE * data.train_spread.mean(axis=0)
    ratio = np.diff(sure, axis=-1)[..., 0] / np.diff(plain, axis=-1)[..., 0]
    np.testing.assert_allclose(ratio, np.broadcast_to(least / (data.new_spread + least), ratio.shape))
    assert (ratio > 0).all()
