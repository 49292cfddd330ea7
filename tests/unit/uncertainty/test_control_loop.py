"""A robot followed through time."""

from __future__ import annotations

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.models.estimators.weighted_mean import weighted_mean
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.intervals import INTERVAL_METHODS
from tests.conftest import bending_arm
from tests.recorded_robot import recorded_arm

GP = {"kernel": "rbf", "trend": "linear", "max_iter": 20, "learning_rows": 150}
ROWS = recorded_arm(700, backlash=0.05, zeros_mm=(0.0, 2.0, -2.0))


@pytest.fixture(scope="module")
def robot() -> CalibratedModel:
    """Fitted and calibrated on the first two sessions."""
    known = ROWS.take(np.arange(466))
    fitted, held_out = known.take(np.arange(466) % 4 > 0), known.take(np.arange(466) % 4 == 0)
    settings = FitSettings(GP, True, 0, 1, memory={"memory": "play", "widths": "all", "zeros": True})
    model = FittedModel("arm", MODELS["gp"], "tuned", fitted_model(MODELS["gp"], settings, fitted), fitted)
    return calibrated(model, INTERVAL_METHODS["scp_crepes"], held_out)


def test_a_loop_a_sequence_and_a_recording_say_the_same(robot: CalibratedModel) -> None:
    first = ROWS.take(np.arange(30))
    followed = robot.follow(first.commands, session=1)
    np.testing.assert_allclose(followed, robot.predict(first.inputs))
    state = robot.start(session=1, confidence_level=0.8)
    steps = [state.step(command) for command in first.commands]
    np.testing.assert_allclose([step.position for step in steps], followed)
    bounds = robot.intervals(first.inputs, [0.8])[0]
    np.testing.assert_allclose([step.lower for step in steps], bounds[..., 0])
    np.testing.assert_allclose([step.upper for step in steps], bounds[..., 1])
    assert np.abs(followed - first.positions).mean() < 0.3 < np.abs(robot.predict(first.commands) - followed).mean()


def test_an_ensemble_is_followed_like_any_model(robot: CalibratedModel) -> None:
    """Of a model that is told of play and one that is told nothing; stored and loaded."""
    line = fitted_model(
        MODELS["lr"], FitSettings({}, True, 0, 1, memory={"memory": "none", "zeros": True}), robot.train
    )
    mean = weighted_mean([robot.estimator, line], [0.75, 0.25], ["gp tuned", "lr outer"])
    held_out = ROWS.take(np.arange(0, 466, 4))
    model = FittedModel("arm", ENSEMBLES["ensemble"], "outer", mean, robot.train)
    both = pickle.loads(pickle.dumps(calibrated(model, INTERVAL_METHODS["scp_crepes"], held_out)))
    first = ROWS.take(np.arange(30))
    followed = both.follow(first.commands, session=1)
    np.testing.assert_allclose(
        followed, 0.75 * robot.follow(first.commands, session=1) + 0.25 * line.predict(first.inputs)
    )
    state = both.start(session=1)
    np.testing.assert_allclose([state.step(command).position for command in first.commands], followed)
    assert "Ensemble (outer) of 75 % gp tuned, 25 % lr outer, fitted on" in repr(both)
    known, unknown = (both.start(session=session).step(first.commands[0]) for session in (1, None))
    assert (unknown.upper - unknown.lower)[0] > (known.upper - known.lower)[0]
    moved = both.recalibrate(first.commands[:20], both.follow(first.commands[:20]) + 2.0)
    assert moved.recalibration.zero[0] == pytest.approx(2.0, abs=0.2)


def test_a_session_never_seen_is_wider_until_it_is_recalibrated(robot: CalibratedModel) -> None:
    new = ROWS.take(np.arange(467, 700))
    known, unknown = (robot.start(session=session).step(new.commands[0]) for session in (1, None))
    assert ((unknown.upper - unknown.lower)[0]) > 3 * ((known.upper - known.lower)[0])
    errors = np.abs(new.positions - robot.follow(new.commands))
    assert errors[:, 0].mean() > 1.0
    again = robot.recalibrate(new.commands[:10], new.positions[:10])
    assert again.recalibration is not None
    assert "10 labelled poses" in again.recalibration.card()
    assert np.abs(new.positions - again.follow(new.commands))[:, 0].mean() < 0.4
    bounds = again.intervals(new.inputs, [0.9])[0]
    covered = (bounds[..., 0] <= new.positions) & (new.positions <= bounds[..., 1])
    assert covered.mean() > 0.85
    assert np.ptp(bounds, axis=-1)[:, 0].max() < (unknown.upper - unknown.lower)[0] / 3
    twice = again.recalibrate(new.commands[:10], new.positions[:10]).recalibration
    assert twice is not None
    np.testing.assert_array_equal(twice.zero, again.recalibration.zero)


def test_a_state_says_what_it_assumes(robot: CalibratedModel) -> None:
    state = robot.start()
    assert "at rest at (0, 0), in a session never seen" in state.assumes
    assert "average of 2 known" in state.assumes
    state.step(ROWS.commands[0])
    assert "was sent the commands so far" in state.assumes
    assert "in session 1 of its recording" in robot.start(session=1).assumes
    again = robot.recalibrate(ROWS.commands[:5], ROWS.positions[:5])
    assert "whose 5 poses were labelled" in again.start().assumes


def test_poses_outside_are_refused(robot: CalibratedModel) -> None:
    with pytest.raises(DataError, match="1 of 2 commands lie in extrapolation"):
        robot.recalibrate(np.array([[0.0, 0.0], [4.0, 4.0]]), np.zeros((2, 3)))


def test_the_watch_notices_the_next_session(robot: CalibratedModel) -> None:
    new = ROWS.take(np.arange(467, 487))
    watch = robot.watch()
    for command, position in zip(new.commands, new.positions, strict=True):
        watch.see(command, position)
    assert watch.alarm is not None
    assert watch.alarm.pose <= 15
    assert "m1_x" in watch.alarm.coordinates


@pytest.mark.parametrize(
    ("command", "says"),
    [
        (ROWS.commands[:2], "2 commands, where one is sent at a time"),
        (ROWS.inputs[0], "expected finite commands of shape"),
        (["0.1", "0.2"], "commands are text"),
        ([True, False], "commands are truth values"),
        ([0.1, float("nan")], "no finite number"),
    ],
)
def test_a_wrong_command_is_refused_and_moves_nothing(robot: CalibratedModel, command: Any, says: str) -> None:
    state, watch = robot.start(), robot.watch()
    with pytest.raises(DataError, match=says):
        state.step(command)
    assert state.last is None
    with pytest.raises(DataError, match=says):
        watch.see(command, ROWS.positions[0])
    np.testing.assert_array_equal(state.step(ROWS.commands[0]), robot.start().step(ROWS.commands[0]))


@pytest.mark.parametrize(
    ("position", "says"), [([1.0, 2.0], "expected positions of shape"), ([1.0, np.nan, 2.0], "no finite number")]
)
def test_a_watch_sees_whole_positions_alone(robot: CalibratedModel, position: Any, says: str) -> None:
    watch, other = robot.watch(), robot.watch()
    with pytest.raises(DataError, match=says):
        watch.see(ROWS.commands[0], position)
    for one in (watch, other):
        one.see(ROWS.commands[1], ROWS.positions[1])
    np.testing.assert_array_equal(watch.errors, other.errors)
    np.testing.assert_array_equal(watch.p_values, other.p_values)


def test_a_sequence_is_of_commands_alone(robot: CalibratedModel) -> None:
    with pytest.raises(DataError, match="expected finite commands of shape"):
        robot.follow(ROWS.inputs[:3])


def test_a_session_that_is_not_in_the_recording_is_an_error(robot: CalibratedModel) -> None:
    with pytest.raises(DataError, match=r"no session 3 in its recording \(\[1, 2\]\)"):
        robot.start(session=3)


def test_a_robot_without_a_recording_is_followed_too() -> None:
    rows = bending_arm(200)
    model = FittedModel(
        "arm", MODELS["gp"], "tuned", fitted_model(MODELS["gp"], FitSettings(GP, True, 0, 1), rows), rows
    )
    robot = calibrated(model, INTERVAL_METHODS["scp_crepes"], rows)
    assert "The command alone decides" in robot.start().assumes
    np.testing.assert_array_equal(robot.follow(rows.commands[:5]), robot.predict(rows.commands[:5]))
    np.testing.assert_allclose(robot.start().step(rows.commands[0]).position, robot.predict(rows.commands[:1])[0])
    moved = replace(rows, positions=rows.positions + 2.0)
    again = robot.recalibrate(moved.commands[:20], moved.positions[:20])
    assert again.recalibration is not None
    np.testing.assert_allclose(again.recalibration.zero, 2.0, atol=0.2)
