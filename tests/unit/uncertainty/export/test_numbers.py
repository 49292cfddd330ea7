from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sklearn.dummy import DummyRegressor

from softkin.core.errors import ConfigError
from softkin.uncertainty.export.numbers import exported_numbers
from tests.exported_robots import TRAIN, small


def test_levels_are_ascending_and_each_has_a_table() -> None:
    numbers = exported_numbers(small("ridge"), [0.9, 0.5, 0.9], most=10**6)
    assert numbers["levels"] == [0.5, 0.9]
    halves = [table["sides"][0, :, 1] for table in numbers["tables"]]
    assert (halves[0] <= halves[1]).all()


def test_what_cannot_be_written_says_so() -> None:
    robot = small("ridge")
    with pytest.raises(ConfigError, match="90 is no confidence level"):
        exported_numbers(robot, [90], most=10**6)
    with pytest.raises(ConfigError, match="more than the 10 that such a file may hold"):
        exported_numbers(robot, most=10)
    other = replace(robot, estimator=DummyRegressor().fit(TRAIN.commands, TRAIN.positions))
    with pytest.raises(ConfigError, match="a DummyRegressor cannot be written as plain numbers"):
        exported_numbers(other, most=10**6)
    with pytest.raises(ConfigError, match="command norm cannot be written"):
        exported_numbers(replace(small("lr"), norm=lambda rows: np.abs(rows).max(axis=1)), most=10**6)
    with pytest.raises(ConfigError, match="intervals of 'scp_mapie' cannot be written"):
        exported_numbers(replace(robot, method=replace(robot.method, scaled=None, name="scp_mapie")), most=10**6)
