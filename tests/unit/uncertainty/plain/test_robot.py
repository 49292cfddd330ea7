from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.plain import robot as module
from softkin.uncertainty.plain.robot import PlainRobot
from tests.conftest import bending_arm
from tests.recorded_robot import recorded_arm
from tests.unit.uncertainty.small_robot import small_robot

NEW = bending_arm(60, seed=9, largest_command=1.8).commands


@pytest.fixture(scope="module")
def remembers() -> CalibratedModel:
    rows = recorded_arm(300, backlash=0.05, zeros_mm=(0.0, 2.0, -2.0))
    fitted, held_out = rows.take(np.arange(300) % 4 > 0), rows.take(np.arange(300) % 4 == 0)
    memory = {"memory": "play", "widths": "all", "zeros": True}
    settings = FitSettings({"degree": 2, "alpha": 1e-3}, True, 0, 1, memory=memory)
    model = FittedModel("arm", MODELS["ridge"], "tuned", fitted_model(MODELS["ridge"], settings, fitted), fitted)
    return calibrated(model, INTERVAL_METHODS["scp_crepes"], held_out)


@pytest.mark.parametrize("is_recalibrated", [False, True])
def test_a_robot_that_remembers_in_plain_numbers(remembers: CalibratedModel, is_recalibrated: bool) -> None:
    rng = np.random.default_rng(5)
    commands = rng.uniform(-0.7, 0.7, (40, 2))
    rows = recorded_arm(40, backlash=0.05, zeros_mm=(0.0,), seed=5, commands=commands)
    robot = remembers.recalibrate(commands[:5], rows.positions[:5]) if is_recalibrated else replace(remembers)
    plain, whole = PlainRobot(robot._prepared.numbers), np.asarray(robot.follow(commands))
    state = robot.start()
    for command, position in zip(commands, whole, strict=True):
        step = state.step(command)
        np.testing.assert_allclose(step.position, position, rtol=0, atol=1e-12)
        half = robot._prepared.table((0.9,))["zero" if not is_recalibrated else "sides"]
        assert (step.upper - step.position >= np.abs(half.reshape(3, -1)).max(axis=1) - 1e-9).all()
    bare = plain.placed(commands)[0]
    np.testing.assert_allclose(bare, np.asarray(robot.predict(commands)), rtol=0, atol=1e-12)


def test_what_lies_outside_in_plain_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = small_robot("scp_distance", shells=True)
    plain = PlainRobot(robot._prepared.numbers)
    norms = plain.norms(NEW)
    np.testing.assert_array_equal(plain.outside(NEW, norms), robot.is_outside(NEW))
    table = robot._prepared.table((0.8, 0.9))
    positions = plain.placed(NEW)[0]
    whole = plain.in_domain(NEW, positions, None, table)
    monkeypatch.setattr(module, "DISTANCES_AT_ONCE", 1000)
    np.testing.assert_array_equal(plain.in_domain(NEW, positions, None, table), whole)
    bounds = plain.everywhere(whole.copy(), positions, plain.outside(NEW, norms), norms, table)
    np.testing.assert_allclose(bounds, robot.intervals(NEW, [0.8, 0.9]), rtol=0, atol=1e-12)
