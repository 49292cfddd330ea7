from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from softkin.uncertainty.intervals.gaussian import crps, intervals
from tests.unit.uncertainty.conftest import spread_calibration


def test_intervals_are_quantiles_of_the_normal_distribution_and_nothing_calibrates_them() -> None:
    data = spread_calibration(12)
    one, two = intervals(data, [0.6826894921370859, 0.9544997361036416])
    np.testing.assert_allclose(one, np.stack([data.new - data.new_spread, data.new + data.new_spread], axis=-1))
    np.testing.assert_allclose(two - data.new[..., None], 2 * (one - data.new[..., None]))
    np.testing.assert_array_equal(intervals(replace(data, truth=1e6 - data.truth), [0.6826894921370859])[0], one)


def test_the_crps_of_a_normal_distribution_is_that_of_its_draws() -> None:
    data, true = spread_calibration(88), np.random.default_rng(9).standard_normal((40, 6)) * 3
    draws = data.new[0, 0] + data.new_spread[0, 0] * np.random.default_rng(0).standard_normal((2, 400_000))
    sampled = np.abs(draws[0] - true[0, 0]).mean() - np.abs(draws[0] - draws[1]).mean() / 2
    assert crps(data, true)[0, 0] == pytest.approx(sampled, rel=5e-3)
    exact = replace(data, new_spread=np.zeros_like(data.new_spread))
    np.testing.assert_array_equal(crps(exact, true), np.abs(true - data.new))
