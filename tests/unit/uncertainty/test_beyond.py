from __future__ import annotations

import numpy as np

from softkin.uncertainty.beyond import Beyond
from tests.conftest import bending_arm
from tests.unit.uncertainty.small_robot import small_robot

NEW = bending_arm(60, seed=9, largest_command=1.8).commands


def test_half_widths_are_those_of_intervals_outside() -> None:
    robot = small_robot(shells=True)
    beyond = Beyond(robot.known, robot.shells, robot.norm)
    outside, norms = beyond.place(NEW)
    np.testing.assert_array_equal(outside, robot.is_outside(NEW))
    assert (outside | (norms <= beyond.radius)).all()
    bounds = np.asarray(robot.intervals(NEW[outside], [0.8, 0.9]))
    halves = np.diff(bounds, axis=-1)[..., 0] / 2
    np.testing.assert_allclose(beyond.half_widths(NEW[outside], (0.8, 0.9)), halves, atol=1e-12)


def test_without_shells_there_is_a_norm_all_the_same() -> None:
    beyond = Beyond(small_robot().known, (), None)
    assert not beyond.has_shells
    assert not beyond.place(small_robot().train.commands)[0].any()
