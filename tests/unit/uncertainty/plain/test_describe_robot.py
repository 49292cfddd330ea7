from __future__ import annotations

import numpy as np
import pytest
from sklearn.dummy import DummyRegressor

from softkin.core.errors import ConfigError
from softkin.core.shells import command_norm
from softkin.models.estimators.weighted_mean import WeightedMean
from softkin.uncertainty.beyond import Beyond
from softkin.uncertainty.plain.describe_robot import estimator_numbers, memory_numbers, place_numbers
from tests.unit.uncertainty.small_robot import small_robot


def test_an_estimator_without_a_describer_is_named() -> None:
    with pytest.raises(ConfigError, match="a DummyRegressor cannot be written as plain numbers"):
        estimator_numbers(DummyRegressor(), small_robot().train, has_spread=False)


def test_a_robot_without_a_recording_remembers_nothing() -> None:
    assert memory_numbers(small_robot().estimator) is None


def test_a_norm_of_another_kind_has_no_centre() -> None:
    known = small_robot().known
    assert "centre" not in place_numbers(Beyond(known, (), lambda rows: np.abs(rows).max(axis=1)))
    assert "centre" in place_numbers(Beyond(known, (), None))
    assert "centre" in place_numbers(Beyond(known, (), command_norm(known.train_commands, standardised=False).of))


def test_a_weighted_mean_has_a_member_for_each_of_its_own() -> None:
    robot = small_robot()
    mean = WeightedMean([robot.estimator, robot.estimator], [0.25, 0.75], ["one", "other"])
    numbers = estimator_numbers(mean, robot.train, has_spread=False)
    assert len(numbers["members"]) == 2
    np.testing.assert_array_equal(numbers["shares"], [0.25, 0.75])
