from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import ConfigError
from softkin.core.rotations import KINDS, to_vectors
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.orientation_model import OrientationModel
from tests.unit.uncertainty.small_robot import small_robot

COMMANDS = np.array([[0.1, 0.2], [-0.3, 0.4], [0.0, 0.0]])


class Turning:
    """Rotates by the first command about x, and by the second about y."""

    def predict(self, commands: np.ndarray) -> np.ndarray:
        return np.pad(commands, ((0, 0), (0, 1)))


def oriented_robot() -> CalibratedModel:
    model = OrientationModel("made up", {}, Turning(), np.zeros(3), np.arange(20.0), None, np.empty(0))
    robot = small_robot()
    return replace(robot, about={**robot.about, "orientation": model})


@pytest.mark.parametrize("kind", KINDS)
def test_rotations_come_in_any_kind_with_a_bound_and_its_promise(kind: str) -> None:
    answer = oriented_robot().orientation(COMMANDS, 0.9, kind)
    assert answer is not None
    np.testing.assert_allclose(to_vectors(np.asarray(answer.rotations), kind)[:, :2], COMMANDS, atol=1e-12)
    assert (answer.bound_deg, answer.guarantee) == (18.0, "marginal")


def test_a_table_is_answered_with_a_table_of_quaternions() -> None:
    commands = pd.DataFrame(COMMANDS, columns=["left", "right"], index=[5, 6, 9])
    answer = oriented_robot().orientation(commands, 0.99)
    assert answer is not None
    assert isinstance(answer.rotations, pd.DataFrame)
    assert list(answer.rotations.columns) == ["qx", "qy", "qz", "qw"]
    assert list(answer.rotations.index) == [5, 6, 9]
    assert answer.bound_deg == np.inf


def test_there_is_none_without_an_orientation_and_no_unknown_kind() -> None:
    assert small_robot().orientation(COMMANDS) is None
    with pytest.raises(ConfigError, match="'euler' is no kind"):
        small_robot().orientation(COMMANDS, kind="euler")
