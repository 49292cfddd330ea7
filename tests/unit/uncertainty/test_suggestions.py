"""Commands worth measuring: far from all that was measured and from each other, within the bounds, named."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.distance import cdist

from softkin.core.errors import DataError
from softkin.core.samples import Array, Samples
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.suggestions import farthest
from tests.conftest import bending_arm
from tests.unit.uncertainty.small_robot import COLUMNS, small_robot
from tests.unit.uncertainty.test_failures import in_slab
from tests.unit.uncertainty.test_failures import robot as failing_robot
from tests.unit.uncertainty.test_inverse import measured, remembering

ROBOT: Any = small_robot(shells=True)
TRAIN = ROBOT.train.commands
LOWER, UPPER = TRAIN.min(axis=0), TRAIN.max(axis=0)


def shares(commands: Array) -> Array:
    return (commands - LOWER) / (UPPER - LOWER)


def arm_of(commands: Array, columns: Any = None) -> Any:
    """A calibrated linear model of an arm recorded at these commands."""
    rows = Samples(commands, measured(commands[:, :2], np.random.default_rng(0)))
    fitted = fitted_model(MODELS["lr"], FitSettings({}, True, 0, 1), rows)
    model = FittedModel("arm", MODELS["lr"], "paper", fitted, rows)
    about = {} if columns is None else {"columns": columns}
    return calibrated(model, INTERVAL_METHODS["scp_crepes"], rows, about=about)


def test_each_lies_far_from_what_was_measured_and_from_those_before() -> None:
    table = ROBOT.suggest(40)
    assert list(table) == ["left", "right", "distance", "width_mm", "outside"]
    commands = table[["left", "right"]].to_numpy()
    assert ((commands >= LOWER) & (commands <= UPPER)).all()
    for row in (0, 1, 17, 39):
        before = np.vstack([shares(TRAIN), shares(commands[:row])])
        assert table["distance"][row] == pytest.approx(cdist(shares(commands[row : row + 1]), before).min())
    assert (np.diff(table["distance"]) <= 1e-12).all()
    at_random = np.random.default_rng(1).uniform(size=(40, 2))
    apart = [cdist(rows, rows)[np.triu_indices(40, 1)].min() for rows in (shares(commands), at_random)]
    assert apart[0] > 2 * apart[1]


def test_they_say_what_the_model_knows_there() -> None:
    table = ROBOT.suggest(20, confidence=0.8)
    named = table[["left", "right"]]
    np.testing.assert_array_equal(table["outside"], ROBOT.is_outside(named))
    bounds = ROBOT.intervals(named.to_numpy(), 0.8)
    np.testing.assert_allclose(table["width_mm"], (bounds[..., 1] - bounds[..., 0]).mean(axis=1))


def test_corners_that_were_never_near_a_recording_are_outside() -> None:
    commands = bending_arm(300, seed=2).commands
    robot = arm_of(commands[np.linalg.norm(commands, axis=1) < 0.9])
    assert robot.suggest(20)["outside"].any()
    assert not robot.suggest(20, inside=True)["outside"].any()


def test_the_first_of_more_are_those_of_fewer_and_a_seed_gives_others() -> None:
    pd.testing.assert_frame_equal(ROBOT.suggest(10), ROBOT.suggest(60)[:10])
    assert not np.isclose(ROBOT.suggest(10, seed=1)["left"], ROBOT.suggest(10)["left"]).any()
    assert ROBOT.suggest().shape[0] == 50


def test_a_gap_in_the_recording_comes_first() -> None:
    commands = bending_arm(300, seed=2).commands
    robot = arm_of(commands[~(commands > 0.1).all(axis=1)])
    first = robot.suggest(8).iloc[:4]
    assert list(first)[:2] == ["u1", "u2"]
    assert (first[["u1", "u2"]] > 0.1).all(axis=None)


def test_where_a_pose_probably_fails_nothing_is_suggested() -> None:
    robot = failing_robot()
    commands = robot.suggest(400)[["left", "right"]].to_numpy()
    assert in_slab(small_robot(shells=True).suggest(400)[["left", "right"]].to_numpy()).sum() > 5
    probability = robot.failure_probability(commands)
    assert probability is not None
    assert (np.asarray(probability) <= 0.5).all()
    assert in_slab(commands).mean() < 0.01


def test_a_command_that_never_varied_stays_as_it_is() -> None:
    commands = np.column_stack([bending_arm(60, seed=2).commands, np.full(60, 7.0)])
    assert (arm_of(commands).suggest(5)["u3"] == 7).all()
    with pytest.raises(DataError, match="no command varies on train"):
        replace(ROBOT, train=replace(ROBOT.train, commands=np.ones_like(TRAIN))).suggest(5)


def test_too_few_commands_inside_are_an_error() -> None:
    along = np.linspace(-1, 1, 60)
    robot = arm_of(np.column_stack([along, along]))
    assert len(robot.suggest(10, inside=True)) == 10
    with pytest.raises(
        DataError, match=r"of 2048 commands .* may be suggested\n  fix: ask for fewer rows than 500, or"
    ):
        robot.suggest(500, inside=True)


def test_names_of_other_columns_are_no_names_of_commands() -> None:
    robot = arm_of(bending_arm(60, seed=2).commands, COLUMNS | {"commands": ["distance", "right"]})
    assert list(robot.suggest(3)) == ["u1", "u2", "distance", "width_mm", "outside"]


def test_another_unit_is_named() -> None:
    robot = replace(small_robot(), about={"unit": "px"})
    assert (robot.suggest(3)["unit"] == "px").all()


def test_a_robot_that_remembers_is_asked_from_rest() -> None:
    table = remembering().suggest(5)
    bounds = remembering().intervals(table[["u1", "u2"]].to_numpy(), 0.9)
    np.testing.assert_allclose(table["width_mm"], (bounds[..., 1] - bounds[..., 0]).mean(axis=1))


def test_points_are_taken_greedily() -> None:
    points = np.array([[0.0], [0.45], [0.6], [1.0]])
    places, distances = farthest(np.array([[0.0]]), points, 3)
    assert places.tolist() == [3, 1, 2]
    np.testing.assert_allclose(distances, [1.0, 0.45, 0.15])
