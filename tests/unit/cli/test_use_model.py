from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.cli.use_model import check_recording, command_table, finite, predicted_table, read_rows
from softkin.core.errors import DataError
from softkin.uncertainty.promise import Promise
from tests.conftest import bending_arm
from tests.unit.uncertainty.small_robot import small_robot
from tests.unit.uncertainty.test_failures import robot as failing_robot
from tests.unit.uncertainty.test_orientations import oriented_robot

ROBOT = small_robot(shells=True)
ROWS = bending_arm(80, seed=3)
COMMANDS = pd.DataFrame(ROWS.commands, columns=["left", "right"])
POSITIONS = pd.DataFrame(ROWS.positions, columns=["m1_x", "m1_y", "m1_z"])


def test_a_table_of_predictions_is_what_the_model_says() -> None:
    table = predicted_table(ROBOT, COMMANDS, 0.8)
    assert list(table.columns)[:3] == ["m1_x", "lower_m1_x", "upper_m1_x"]
    np.testing.assert_array_equal(table[["m1_x", "m1_y", "m1_z"]], ROBOT.predict(ROWS.commands))
    np.testing.assert_array_equal(table["upper_m1_z"], ROBOT.intervals(ROWS.commands, 0.8)[:, 2, 1])
    np.testing.assert_array_equal(table["outside"], ROBOT.is_outside(ROWS.commands))


def test_joint_bounds_hold_the_whole_pose_and_are_named_so() -> None:
    table = predicted_table(ROBOT, COMMANDS, 0.8, joint=True)
    assert list(table.columns)[:3] == ["m1_x", "joint_lower_m1_x", "joint_upper_m1_x"]
    np.testing.assert_array_equal(table["joint_upper_m1_z"], ROBOT.joint_intervals(ROWS.commands, 0.8).bounds[:, 2, 1])
    assert (table["joint_upper_m1_z"] >= predicted_table(ROBOT, COMMANDS, 0.8)["upper_m1_z"]).all()


def test_an_orientation_is_a_quaternion_with_its_bound() -> None:
    table = predicted_table(oriented_robot(), COMMANDS, 0.9)
    names = ["tip_qx", "tip_qy", "tip_qz", "tip_qw"]
    assert list(table.columns)[-5:] == [*names, "bound_deg"]
    np.testing.assert_allclose(np.linalg.norm(table[names], axis=1), 1.0)
    assert set(table["bound_deg"]) == {18.0}


def test_a_robot_that_fails_has_the_probability_of_it() -> None:
    robot, commands = failing_robot(), pd.DataFrame({"left": [0.53, -0.5], "right": [0.1, 0.2]})
    table = predicted_table(robot, commands, 0.9)
    assert list(table.columns)[-3:] == ["outside", "failure_probability", "may_fail"]
    assert table["may_fail"].tolist() == [True, False]
    np.testing.assert_array_equal(table["failure_probability"], robot.failure_probability(commands.to_numpy()))
    assert "may_fail" not in predicted_table(ROBOT, commands, 0.9)


def test_a_robot_where_it_is_said_to_be_raises_no_alarm_and_one_elsewhere_does() -> None:
    well = check_recording(ROBOT, COMMANDS, POSITIONS, 0.01)
    assert (well.n_poses, well.alarm_pose) == (80, None)
    assert well.n_outside == np.asarray(ROBOT.is_outside(COMMANDS)).sum() < 20
    assert well.share_of_small_p_values == pytest.approx(0.1, abs=0.1)
    assert "No alarm" in well.sentences()[-1]
    moved = check_recording(ROBOT, COMMANDS, POSITIONS + np.array([2.0, 0.0, 0.0]), 0.01)
    assert moved.alarm_pose is not None
    assert moved.alarm_pose < 40
    assert "ALARM" in moved.sentences()[-1]
    far = check_recording(ROBOT, COMMANDS * 0 + 9.0, POSITIONS, 0.01)
    assert far.share_of_small_p_values is None
    assert "nothing can be said" in far.sentences()[-1]


def test_columns_are_found_by_name_and_the_others_are_named(tmp_path: Path) -> None:
    path = tmp_path / "today.csv"
    own = (POSITIONS / 10).set_axis(["tip x", "tip y", "tip z"], axis=1)
    pd.concat([own, COMMANDS[["right", "left"]]], axis=1).assign(t=range(80)).to_csv(path, index=False)
    commands, positions, unread = read_rows(path, ROBOT.names, measured=True)
    np.testing.assert_allclose(commands, ROWS.commands)
    assert positions is not None
    np.testing.assert_allclose(positions, ROWS.positions)
    assert unread == ["t"]
    COMMANDS[["left"]].assign(t=0.0).to_csv(path, index=False)
    with pytest.raises(DataError, match="missing 'right'") as caught:
        read_rows(path, ROBOT.names, measured=False)
    assert caught.value.where == str(path)
    with pytest.raises(DataError, match="no such file"):
        read_rows(tmp_path / "none.csv", ROBOT.names, measured=False)


def test_json_gets_no_infinity() -> None:
    assert [finite(value) for value in (1.5, float("inf"), True)] == [1.5, None, True]


def test_a_robot_in_pixels_says_so() -> None:
    robot = replace(ROBOT, about={"unit": "px"})
    rows = COMMANDS.set_axis(["u1", "u2"], axis=1)
    table = predicted_table(robot, rows, 0.8)
    assert (list(table.columns)[-1], set(table["unit"])) == ("unit", {"px"})
    pd.testing.assert_frame_equal(table.drop(columns="unit"), predicted_table(ROBOT, COMMANDS, 0.8))
    assert " px of where the model says" in check_recording(robot, rows, POSITIONS, 0.01).sentences()[1]
    wished = command_table(robot, POSITIONS.iloc[:1], -1, 0.9, None, path=False)
    assert wished["unit"].tolist() == ["px"]
    assert " mm" not in repr(robot)
    assert " px mean marker error" in repr(robot)


def test_of_blocks_a_check_says_what_its_p_values_and_its_alarm_are_worth() -> None:
    assert "no guarantee" not in " ".join(check_recording(ROBOT, COMMANDS, POSITIONS, 0.01).sentences())
    for promise, expected in ((Promise(12, 5), "at most 10% have"), (Promise(4, 15), "P-values have no guarantee")):
        robot = replace(ROBOT, joint=replace(ROBOT.joint, promise=promise))
        said = " ".join(check_recording(robot, COMMANDS, POSITIONS + np.array([2.0, 0.0, 0.0]), 0.01).sentences())
        assert expected in said
        assert "The rate of false alarms has no guarantee" in said
        assert "or only this stretch of time is unlike" in said
