"""Failures that commands foretell make a class; those that they do not, and clean robots, make none."""

from __future__ import annotations

import pickle
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray

from softkin.core.samples import Array, Samples
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.failures import FailureClass, failure_class
from tests.conftest import bending_arm
from tests.unit.uncertainty.small_robot import small_robot

#: Where an arm of `failing` fails: a slab of 3 % of the commands.
SLAB = (0.5, 0.56)


def in_slab(commands: Array) -> NDArray[np.bool_]:
    return np.asarray((commands[:, 0] > SLAB[0]) & (commands[:, 0] < SLAB[1]))


def failing(n_rows: int, seed: int, *, foretold: bool = True) -> tuple[Samples, NDArray[np.bool_]]:
    """An arm that keeps one pose in nine of ten cases in the slab, or in as many rows anywhere; and which rows."""
    rows, rng = bending_arm(n_rows, seed=seed), np.random.default_rng(seed)
    place = in_slab(rows.commands) if foretold else rng.permutation(in_slab(rows.commands))
    failed = place & (rng.uniform(size=n_rows) < 0.9)
    positions = rows.positions.copy()
    positions[failed] = [60.0, -60.0, 20.0]
    return Samples(rows.commands, positions), failed


@cache
def found() -> FailureClass:
    of_failures = failure_class(failing(900, 0)[0])
    assert of_failures is not None
    return of_failures


def robot() -> CalibratedModel:
    return replace(small_robot(shells=True), failures=found())


def test_the_probability_is_that_of_new_rows() -> None:
    new, failed = failing(6000, 1)
    probability = found().probability(new.commands)
    slab = in_slab(new.commands)
    assert probability[slab].mean() == pytest.approx(failed[slab].mean(), abs=0.15)
    assert probability[~slab].mean() < 0.01
    assert abs(probability.mean() - failed.mean()) < 0.01
    assert found().n_rows == 900
    assert found().n_failed == failing(900, 0)[1].sum()


def test_it_is_the_probability_of_the_classifier_without_its_checks_of_each_row() -> None:
    commands = bending_arm(500, seed=8).commands
    said = found().classifier.predict_proba(commands)[:, 1]
    np.testing.assert_array_equal(found().probability(commands), said)
    np.testing.assert_array_equal([found().probability(row)[0] for row in np.split(commands, 500)], said)
    assert len(np.unique(said)) > 1


def test_a_command_that_32_bits_do_not_hold_is_answered() -> None:
    far: Any = robot().failure_probability([[1e60, 0.0], [1e9, 0.0]])
    assert far[0] == far[1]


def test_where_it_may_fail_is_the_slab_and_little_else() -> None:
    commands = bending_arm(6000, seed=2).commands
    (flagged,) = found().may_fail(commands, [0.9])
    slab = in_slab(commands)
    assert flagged[slab].mean() > 0.85
    assert flagged[~slab].mean() < 0.01


def test_a_high_level_does_not_flag_rows_that_fail_less_than_most() -> None:
    commands = bending_arm(2000, seed=3).commands
    none, all_levels = found().may_fail(commands, [0.5])[0], found().may_fail(commands, [0.9, 0.9999999])
    assert none.sum() <= all_levels[0].sum() <= all_levels[1].sum() < 0.1 * len(commands)


@pytest.mark.parametrize("seed", range(4))
def test_errors_that_commands_do_not_foretell_make_no_class(seed: int) -> None:
    assert failure_class(failing(900, seed, foretold=False)[0]) is None
    assert failure_class(bending_arm(400, seed=seed)) is None


def test_few_failures_make_no_class() -> None:
    rows, failed = failing(900, 0)
    keep = np.flatnonzero(~failed).tolist() + np.flatnonzero(failed)[:9].tolist()
    assert failure_class(rows.take(np.array(keep))) is None


def test_intervals_say_so_and_are_as_they_were_elsewhere() -> None:
    commands = bending_arm(400, seed=4).commands
    bare: Any = small_robot(shells=True)
    (flagged,) = found().may_fail(commands, [0.9])
    knowing: Any = robot()
    for plain, wide in (
        [one.intervals(commands, 0.9) for one in (bare, knowing)],
        [one.joint_intervals(commands, 0.9).bounds for one in (bare, knowing)],
    ):
        np.testing.assert_array_equal(plain[~flagged], wide[~flagged])
        assert (wide[flagged, :, 0] <= np.minimum(plain[flagged, :, 0], found().lower)).all()
        assert (wide[flagged, :, 1] >= np.maximum(plain[flagged, :, 1], found().upper)).all()


def test_whole_failed_poses_are_held_where_poses_may_fail() -> None:
    new, failed = failing(3000, 5)
    regions = robot().joint_intervals(new.commands, 0.9)
    held, flagged = np.asarray(regions.contains(new.positions)), found().may_fail(new.commands, [0.9])[0]
    assert (flagged & failed).sum() > 50
    assert held[flagged & failed].all()
    bare = np.asarray(small_robot(shells=True).joint_intervals(new.commands, 0.9).contains(new.positions))
    assert not bare[flagged & failed].any()
    np.testing.assert_array_equal(held[~flagged], bare[~flagged])
    assert (np.asarray(regions.sizes_mm)[flagged] > 20).all()


def test_the_model_answers_as_it_is_asked_and_none_where_there_is_no_class() -> None:
    table = pd.DataFrame(bending_arm(5, seed=6).commands, columns=["left", "right"], index=[9, 7, 5, 3, 1])
    asked = robot().failure_probability(table)
    assert isinstance(asked, pd.Series)
    assert (asked.name, list(asked.index)) == ("failure_probability", [9, 7, 5, 3, 1])
    np.testing.assert_array_equal(asked, robot().failure_probability(table.to_numpy()))
    assert small_robot().failure_probability(table) is None
    again = pickle.loads(pickle.dumps(robot()))
    np.testing.assert_array_equal(again.failure_probability(table), asked)
