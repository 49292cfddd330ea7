"""What is worked out once gives what working it out for each command gives, to 1e-12."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.core.shells import command_norm
from softkin.training.predict import spread_of
from softkin.uncertainty import beyond, error_growth
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.calibration_data import ShellCalibration, SpreadCalibration
from softkin.uncertainty.intervals import INTERVAL_METHODS, in_domain_and_extrapolation
from softkin.uncertainty.promise import Promise, promised
from tests.conftest import bending_arm
from tests.exported_robots import noiseless, small
from tests.unit.tracking.robots import robot as gaussian_process
from tests.unit.tracking.robots import with_shells
from tests.unit.uncertainty.small_robot import small_robot

NEW = bending_arm(300, seed=9, largest_command=1.8).commands
LEVELS = (0.5, 0.8, 0.9, 0.95, 0.999)


def of_gaussian_process() -> CalibratedModel:
    model = with_shells(gaussian_process())
    return replace(model, norm=command_norm(model.train.commands, standardised=False).of)


def by_block(robot: CalibratedModel) -> CalibratedModel:
    """The same, calibrated on twelve blocks of five rows."""
    promise = Promise(12, 5)
    return replace(robot, method=promised(robot.method, promise), joint=replace(robot.joint, promise=promise))


ROBOTS = {method: small_robot(method, shells=True) for method in ("scp_mapie", "scp_crepes", "scp_distance", "cps")}
ROBOTS |= {"scp_spread": of_gaussian_process(), "no shells": small_robot()}
ROBOTS |= {f"{name}, by block": by_block(ROBOTS[name]) for name in ("scp_crepes", "scp_mapie", "cps", "no shells")}


def slow_intervals(robot: CalibratedModel) -> np.ndarray:
    """As they were made before anything was kept."""
    data = replace(robot.known, new=np.asarray(robot.predict(NEW)), new_commands=NEW)
    if isinstance(data, SpreadCalibration):
        data = replace(data, new_spread=spread_of(robot.spec, robot.estimator, robot.train, NEW))
    bounds = robot.method.intervals(data, LEVELS)
    if robot.norm is None:
        return bounds
    has_spread = robot.method.calibrated_on.has_spread
    shells = ShellCalibration(data, robot.shells, robot.norm, bounds, has_spread)
    return promised(in_domain_and_extrapolation.METHOD, robot.joint.promise).intervals(shells, LEVELS)


@pytest.mark.parametrize("name", ROBOTS)
def test_intervals_are_those_of_the_slow_path(name: str) -> None:
    robot = ROBOTS[name]
    slow = slow_intervals(robot)
    np.testing.assert_allclose(robot.intervals(NEW, LEVELS), slow, rtol=0, atol=1e-12)
    for place in (0, 150, 299):
        np.testing.assert_allclose(robot.intervals(NEW[place], LEVELS)[:, 0], slow[:, place], rtol=0, atol=1e-10)


@pytest.mark.parametrize("name", ROBOTS)
def test_what_is_outside_is_what_the_slow_path_says(name: str) -> None:
    robot = ROBOTS[name]
    norm = robot.norm or command_norm(robot.train.commands, standardised=True).of
    data = ShellCalibration(replace(robot.known, new_commands=NEW), robot.shells, norm)
    outside = np.asarray(robot.is_outside(NEW))
    np.testing.assert_array_equal(outside, in_domain_and_extrapolation.is_in_extrapolation(data))
    assert 20 < outside.sum() < 280
    inside = robot.train.commands
    assert np.asarray(robot.is_outside(inside)).sum() == 0


@pytest.mark.parametrize("name", ROBOTS)
def test_few_rows_are_predicted_as_many_are(name: str) -> None:
    robot = ROBOTS[name]
    few = robot._prepared.predicted_of_few(NEW[:4])
    np.testing.assert_allclose(few, robot.estimator.predict(NEW[:4]), rtol=0, atol=1e-9)


def test_many_rows_of_kernels_that_cancel_are_answered_as_one_row_is() -> None:
    robot = noiseless()
    assert robot._prepared.is_plain
    many, one = np.asarray(robot.intervals(NEW, 0.9)), np.stack([robot.intervals(row, 0.9)[0] for row in NEW[:60]])
    np.testing.assert_allclose(many[:60], one, rtol=0, atol=1e-10)


def test_many_rows_of_trees_and_networks_are_handed_to_the_estimator() -> None:
    assert small("ridge")._prepared.is_plain
    for name in ("xgb", "mlp"):
        robot = replace(small(name), method=INTERVAL_METHODS["scp_crepes"])
        assert not robot._prepared.is_plain
        np.testing.assert_array_equal(robot.predict(NEW), robot.estimator.predict(NEW))


def test_spreads_of_many_rows_are_kept_no_longer_than_a_call(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = replace(ROBOTS["scp_spread"])
    placed, calls = robot._prepared.plain.placed, list[int]()

    def counted(inputs: Array) -> tuple[Array, Array | None]:
        calls.append(len(inputs))
        return placed(inputs)

    monkeypatch.setattr(robot._prepared.plain, "placed", counted)
    first, second = robot.intervals(NEW, 0.9), robot.intervals(NEW, 0.9)
    np.testing.assert_array_equal(first, second)
    assert calls == [len(NEW), len(NEW)]


def test_nothing_is_fitted_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    fits: list[int] = []

    def counted(data: ShellCalibration) -> list[error_growth.ErrorGrowth]:
        fits.append(1)
        return error_growth.fit_error_growth(data)

    monkeypatch.setattr(beyond, "fit_error_growth", counted)
    robot = replace(small_robot(shells=True))
    for row in NEW[:40]:
        robot.intervals(row, 0.9)
    assert fits == [1]


def test_a_control_loop_has_everything_ready_before_its_first_command(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = replace(small_robot(shells=True))
    state = robot.start()

    def fitted(data: ShellCalibration) -> list[error_growth.ErrorGrowth]:
        raise AssertionError(data)

    monkeypatch.setattr(beyond, "fit_error_growth", fitted)
    monkeypatch.setattr(beyond, "conformal_limits", fitted)
    far = state.step(NEW[np.argmax(np.linalg.norm(NEW, axis=1))])
    assert np.isfinite(far.upper).all()
