from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.calibration_data import (
    FoldCalibration,
    PointCalibration,
    PredictiveCalibration,
    QuantileCalibration,
    ResampleCalibration,
    ShellCalibration,
    SpreadCalibration,
)
from tests.unit.uncertainty.conftest import point_calibration, quantile_calibration, spread_calibration

KEPT, HELD_OUT = np.array([4, 0, 7, 9]), np.array([2, 8])


@pytest.mark.parametrize("data", [point_calibration(12), spread_calibration(12)])
def test_points_are_resplit_with_all_that_belongs_to_their_rows(data: PointCalibration) -> None:
    part = data.resplit(KEPT, HELD_OUT)
    assert type(part) is type(data)
    np.testing.assert_array_equal(part.calibration, data.calibration[KEPT])
    np.testing.assert_array_equal(part.truth, data.truth[KEPT])
    np.testing.assert_array_equal(part.new, data.calibration[HELD_OUT])
    np.testing.assert_array_equal(part.calibration_commands, data.calibration_commands[KEPT])
    np.testing.assert_array_equal(part.new_commands, data.calibration_commands[HELD_OUT])
    assert part.train_commands is data.train_commands


def test_spreads_are_resplit_with_their_rows() -> None:
    data = spread_calibration(12)
    part = data.resplit(KEPT, HELD_OUT)
    np.testing.assert_array_equal(part.calibration_spread, data.calibration_spread[KEPT])
    np.testing.assert_array_equal(part.new_spread, data.calibration_spread[HELD_OUT])
    assert part.train_spread is data.train_spread


def test_quantiles_are_resplit_at_every_level() -> None:
    data = quantile_calibration(12)
    part = data.resplit(KEPT, HELD_OUT)
    assert part.calibration.shape == (3, 4, 6, 2)
    np.testing.assert_array_equal(part.calibration, data.calibration[:, KEPT])
    np.testing.assert_array_equal(part.new, data.calibration[:, HELD_OUT])
    np.testing.assert_array_equal(part.truth, data.truth[KEPT])


def test_a_kind_says_which_stored_outputs_it_needs() -> None:
    kinds = (PointCalibration, SpreadCalibration, PredictiveCalibration, QuantileCalibration)
    kinds_of_refits = (FoldCalibration, ResampleCalibration, ShellCalibration)
    needs = [(k.needs_quantiles, k.needs_refits, k.needs_shells) for k in (*kinds, *kinds_of_refits)]
    assert needs == [
        *[(False, False, False)] * 3,
        (True, False, False),
        *[(False, True, False)] * 2,
        (False, False, True),
    ]
    assert [k.has_spread for k in kinds] == [False, True, True, False]
    assert [k for k in (*kinds, *kinds_of_refits) if not k.is_around_a_model] == [QuantileCalibration]
    assert [k for k in (*kinds, *kinds_of_refits) if k.is_for_extrapolation] == [ShellCalibration]
