"""Commands for targets: reached, bounded, promised; along paths; of robots that remember."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any
from unittest.mock import Mock

import numpy as np
import pandas as pd
import pytest
from scipy.stats import binom

from softkin.core.samples import Array, Samples
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.command_answers import NEAREST, OUTSIDE, REACHABLE
from softkin.uncertainty.failures import FailureClass
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.promise import Promise
from tests.recorded_robot import NOISE_MM, bent, recorded_arm
from tests.unit.uncertainty.small_robot import small_robot

INSIDE = np.random.default_rng(5).uniform(-0.8, 0.8, (12, 2))
ROBOT: Any = small_robot(shells=True)
LOWER, UPPER = ROBOT.train.commands.min(axis=0), ROBOT.train.commands.max(axis=0)


def measured(commands: Array, rng: np.random.Generator) -> Array:
    """A simulated arm, as it is measured."""
    return bent(commands) + NOISE_MM * rng.standard_normal((len(commands), 3))


@cache
def remembering() -> Any:
    """A linear model that is told of play, of two sessions."""
    rows = recorded_arm(400, backlash=0.05, zeros_mm=(0.0, 1.0))
    fitted, held_out = rows.take(np.arange(400) % 4 > 0), rows.take(np.arange(400) % 4 == 0)
    settings = FitSettings({}, True, 0, 1, memory={"memory": "play", "widths": "all", "zeros": True})
    model = FittedModel("arm", MODELS["lr"], "tuned", fitted_model(MODELS["lr"], settings, fitted), fitted)
    return calibrated(model, INTERVAL_METHODS["scp_crepes"], held_out)


def test_positions_of_commands_inside_are_reached() -> None:
    targets = ROBOT.predict(INSIDE)
    found = ROBOT.command_for(targets, confidence=0.8)
    assert (found.verdict == REACHABLE).all()
    np.testing.assert_allclose(found.commands, INSIDE, atol=1e-6)
    np.testing.assert_allclose(found.positions, targets, atol=1e-5)
    assert found.residual_mm.max() < 1e-5
    np.testing.assert_array_equal(found.intervals, ROBOT.intervals(found.commands, 0.8))
    assert found.probability is None


def test_what_cannot_be_reached_is_approached_within_the_bounds() -> None:
    target = np.array([[90.0, 20.0, 80.0]])
    found = ROBOT.command_for(target, tolerance=1.0)
    grid = np.stack(np.meshgrid(*np.linspace(LOWER, UPPER, 201).T), axis=-1).reshape(-1, 2)
    nearest = np.linalg.norm(ROBOT.predict(grid) - target, axis=1).min()
    assert found.residual_mm[0] == pytest.approx(nearest, rel=1e-4)
    assert found.residual_mm[0] <= nearest + 1e-9
    assert ((found.commands >= LOWER) & (found.commands <= UPPER)).all()
    assert found.verdict[0] == (OUTSIDE if ROBOT.is_outside(found.commands)[0] else NEAREST)
    assert found.probability[0] == 0
    assert found.within_mm[0] > found.residual_mm[0] - 1
    beside = ROBOT.command_for(ROBOT.predict(INSIDE[:3]) + np.array([0.0, 0.0, 2.0]))
    assert (beside.verdict == NEAREST).all()
    assert (beside.residual_mm < 2).all()
    assert (beside.residual_mm > 1).all()


def test_where_a_pose_may_fail_a_target_beside_it_is_not_reachable() -> None:
    """Intervals hold the failed poses there; how near the robot comes where it does not fail stays as it was."""
    failures = Mock(spec=FailureClass)
    failures.may_fail.return_value = np.ones((1, 3), dtype=bool)
    failures.widened.side_effect = lambda bounds, *_: bounds + np.array([-100.0, 100.0])
    failing = replace(ROBOT, failures=failures)
    targets = ROBOT.predict(INSIDE[:3]) + np.array([0.0, 0.0, 2.0])
    found, regular = failing.command_for(targets), ROBOT.command_for(targets)
    np.testing.assert_array_equal(found.commands, regular.commands)
    np.testing.assert_array_equal(found.verdict, regular.verdict)
    assert (found.verdict == NEAREST).all()
    assert (found.within_mm > regular.within_mm + 50).all()


def test_a_simulated_robot_is_within_what_is_promised() -> None:
    """Held-out measured positions as targets; sent the commands, the robot is within `within_mm` as often as said."""
    rng, n = np.random.default_rng(3), 60
    commands = [rng.uniform(-1, 1, (rows, 2)) for rows in (120, 99, n)]
    train, validation, held_out = (Samples(rows, measured(rows, rng)) for rows in commands)
    settings = FitSettings({"degree": 3, "alpha": 1e-3}, True, 0, 1)
    model = FittedModel("arm", MODELS["ridge"], "tuned", fitted_model(MODELS["ridge"], settings, train), train)
    robot: Any = calibrated(model, INTERVAL_METHODS["scp_crepes"], validation)
    found = robot.command_for(held_out.positions, tolerance=0.4)
    distances = np.linalg.norm(measured(found.commands, rng) - held_out.positions, axis=1)
    assert (distances <= found.within_mm).sum() >= binom.ppf(0.005, n, 0.9)
    assert np.median(found.within_mm) < 4 * NOISE_MM
    assert (found.verdict == REACHABLE).mean() > 0.8
    expected = found.probability.sum()
    assert (distances <= 0.4).sum() >= expected - 2.6 * np.sqrt(n / 4)
    assert 0.3 * n < expected < n


def test_the_promise_is_a_rank_among_the_errors_of_the_calibration_set() -> None:
    robot: Any = small_robot()
    target = robot.predict(INSIDE[:1])
    errors = np.sort(np.linalg.norm(robot.known.truth - robot.known.calibration, axis=1))
    found = robot.command_for(target, confidence=0.9, tolerance=float(errors[29]))
    assert found.within_mm[0] == pytest.approx(errors[54], rel=1e-4)  # of 60, rank ceil(0.9 * 61) = 55
    assert found.probability[0] == pytest.approx(30 / 61, abs=1.5 / 61)
    assert robot.command_for(target, confidence=0.99, tolerance=1.0).within_mm[0] == np.inf
    blocks = replace(robot, joint=replace(robot.joint, promise=Promise(6, 10)))
    found = blocks.command_for(target, confidence=0.8, tolerance=float(errors[29]))
    assert found.within_mm[0] == pytest.approx(errors[55], rel=1e-4)  # rank ceil(0.8 * 7 * 10) = 56
    assert found.probability[0] == pytest.approx(30 / 70, abs=1.5 / 70)


def test_outside_the_promise_grows_with_the_intervals() -> None:
    robot: Any = small_robot(shells=True)
    found = robot.command_for(robot.predict([UPPER, INSIDE[0]]), tolerance=0.4)
    assert found.verdict.tolist() == [OUTSIDE, REACHABLE]
    assert found.within_mm[0] > 1.2 * found.within_mm[1]
    assert found.probability[0] < found.probability[1]


def test_a_table_is_answered_by_one() -> None:
    targets = pd.DataFrame(ROBOT.predict(INSIDE) / 10, columns=["tip x", "tip y", "tip z"])[::-1]
    table = ROBOT.command_for(targets, marker=0, tolerance=1.0)
    assert table.index.equals(targets.index)
    assert list(table.columns[:5]) == ["left", "right", "m1_x", "lower_m1_x", "upper_m1_x"]
    assert list(table.columns[-4:]) == ["residual_mm", "within_mm", "probability", "verdict"]
    np.testing.assert_allclose(table[["left", "right"]], INSIDE[::-1], atol=1e-6)
    np.testing.assert_allclose(ROBOT.predict(table[["left", "right"]])["m1_z"], table["m1_z"])


def test_a_path_is_continuous_and_keeps_the_rate() -> None:
    turn = np.linspace(0, 2 * np.pi, 40)
    along = 0.7 * np.column_stack([np.cos(turn), np.sin(turn)])
    found = ROBOT.command_path(ROBOT.predict(along))
    assert (found.verdict == REACHABLE).all()
    np.testing.assert_allclose(found.commands, along, atol=1e-6)
    slow = ROBOT.command_path(ROBOT.predict(along[:20]), last=[0.0, 0.0], max_step=[0.08, 0.05])
    steps = np.abs(np.diff(slow.commands, axis=0, prepend=[[0.0, 0.0]]))
    assert (steps <= np.array([0.08, 0.05]) * (1 + 1e-12)).all()
    assert slow.verdict[0] == NEAREST
    one = ROBOT.command_for(ROBOT.predict(along[:1]), last=[0.0, 0.0], max_step=[0.08, 0.05])
    np.testing.assert_allclose(one.commands[0], slow.commands[0])


def test_a_robot_that_remembers_is_asked_from_where_it_is() -> None:
    robot, sent = remembering(), INSIDE[:5]
    state = robot.start(session=2)
    for command in sent:
        state.step(command)
    wanted = INSIDE[6:9]
    targets = np.vstack([robot.predict(state.next_inputs(row[None])) for row in wanted])
    found = robot.command_for(targets, last=state)
    np.testing.assert_array_equal(state.last, sent[-1])
    np.testing.assert_allclose(found.positions, robot.predict(state.next_inputs(found.commands)))
    path = robot.command_path(targets, last=state)
    np.testing.assert_array_equal(state.last, sent[-1])
    assert found.residual_mm.max() < 1e-3
    assert path.residual_mm[0] < 1e-3
    followed = [state.step(command).position for command in path.commands]
    np.testing.assert_allclose(path.positions, followed)
    rest = robot.command_for(targets)
    np.testing.assert_allclose(rest.positions, robot.predict(rest.commands))
    one = robot.start()
    one.step(sent[-1])
    np.testing.assert_array_equal(
        robot.command_for(targets, last=sent[-1]).commands, robot.command_for(targets, last=one).commands
    )
