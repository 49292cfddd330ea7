"""What the file of a calibrated model holds, and that one of another format is refused."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest

from softkin.core.errors import ResultError
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.file_format import FORMAT, restore, stored_state
from tests.unit.uncertainty.small_robot import small_robot


def test_it_holds_the_fields_and_the_format_alone() -> None:
    robot = replace(small_robot())
    robot.intervals([0.1, 0.2], 0.9)
    robot.joint_intervals([0.1, 0.2], 0.9)
    state = stored_state(robot)
    assert set(state) == {"format", *(one.name for one in fields(robot))}
    again = CalibratedModel.__new__(CalibratedModel)
    restore(again, state)
    np.testing.assert_array_equal(again.intervals([0.1, 0.2], 0.9), robot.intervals([0.1, 0.2], 0.9))


@pytest.mark.parametrize("state", [{}, ["arm"], {"format": 2}, {"format": FORMAT + 1}])
def test_another_format_is_refused(state: object) -> None:
    with pytest.raises(ResultError, match=rf"of format \d+, where this version of softkin reads {FORMAT}"):
        restore(CalibratedModel.__new__(CalibratedModel), state)
