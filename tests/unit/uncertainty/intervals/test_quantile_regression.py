from __future__ import annotations

from dataclasses import replace

import numpy as np

from softkin.uncertainty.calibration_data import QuantileCalibration
from softkin.uncertainty.intervals.quantile_regression import METHOD, intervals
from tests.unit.uncertainty.conftest import LEVELS, quantile_calibration


def test_intervals_are_the_predicted_quantiles() -> None:
    data = quantile_calibration(12)
    np.testing.assert_array_equal(intervals(data, LEVELS), data.new)
    np.testing.assert_array_equal(intervals(data, LEVELS[1:2]), data.new[1:2])


def test_there_are_intervals_at_fitted_levels_only() -> None:
    data = quantile_calibration(12)
    assert METHOD.levels(data, [0.5, *LEVELS]) == list(LEVELS)
    assert METHOD.levels(replace(data, levels=LEVELS[1:2]), LEVELS) == [LEVELS[1]]


def test_crossed_quantiles_are_put_in_order() -> None:
    data = quantile_calibration(140)
    crossed = QuantileCalibration(data.calibration[..., ::-1], data.truth, data.new[..., ::-1], LEVELS)
    np.testing.assert_array_equal(intervals(crossed, LEVELS), intervals(data, LEVELS))


def test_true_positions_do_not_matter() -> None:
    data = quantile_calibration(12)
    other = QuantileCalibration(data.calibration, 1e6 - data.truth, data.new, LEVELS)
    np.testing.assert_array_equal(intervals(other, LEVELS), intervals(data, LEVELS))
