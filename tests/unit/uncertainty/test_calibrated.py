from __future__ import annotations

import numpy as np

from tests.conftest import bending_arm
from tests.unit.uncertainty.small_robot import small_robot


def test_predictions_on_the_calibration_set_are_stored_with_what_is_known_of_the_robot() -> None:
    robot, validation = small_robot(), bending_arm(60, seed=7)
    np.testing.assert_array_equal(robot.known.calibration, robot.estimator.predict(validation.commands))
    np.testing.assert_array_equal(robot.known.truth, validation.positions)
    assert robot.about["data"] == "ab" * 32
    assert small_robot(named=False).about == {}
