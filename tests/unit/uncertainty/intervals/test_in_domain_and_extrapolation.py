from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from softkin.core.metrics.interval import covered
from softkin.core.samples import Samples
from softkin.core.shells import command_norm, outer_shells
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibration_data import PointCalibration, Shell, ShellCalibration
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.intervals.in_domain_and_extrapolation import intervals, is_in_extrapolation
from tests.conftest import bending_arm
from tests.unit.uncertainty.conftest import LEVELS, shell_calibration


def test_in_domain_it_is_split_conformal_and_in_extrapolation_never_narrower() -> None:
    data = shell_calibration(88)
    bounds, split, rolling = (
        INTERVAL_METHODS[name].intervals(calibration, LEVELS)
        for name, calibration in (("auto", data), ("scp_mapie", data.deployed), ("rolling_shells", data))
    )
    far = is_in_extrapolation(data)
    assert far.tolist() == [False] * 20 + [True] * 20
    np.testing.assert_allclose(bounds[:, ~far], split[:, ~far], atol=1e-9)
    width, least, by_shells = (np.diff(of_method, axis=-1)[:, far] for of_method in (bounds, split, rolling))
    np.testing.assert_allclose(width, np.maximum(least, by_shells), atol=1e-9)


def test_where_all_commands_are_in_domain_bounds_are_those_of_the_in_domain_method() -> None:
    data = shell_calibration(88)
    near = replace(data, deployed=replace(data.deployed, new_commands=data.deployed.train_commands[:40]))
    inner = INTERVAL_METHODS["scp_distance"].intervals(near.deployed, LEVELS)
    np.testing.assert_array_equal(intervals(replace(near, in_domain=inner), LEVELS), inner)


def test_an_in_domain_method_that_grows_with_the_distance_is_ignored_in_extrapolation() -> None:
    """A real finger's errors do not grow with it: intervals were four times as wide as the oracle's."""
    data = shell_calibration(88)
    grown = INTERVAL_METHODS["scp_distance"].intervals(data.deployed, LEVELS)
    bounds = intervals(replace(data, in_domain=grown), LEVELS)
    far = is_in_extrapolation(data)
    np.testing.assert_array_equal(bounds[:, ~far], grown[:, ~far])
    np.testing.assert_array_equal(bounds[:, far], intervals(data, LEVELS)[:, far])


def test_an_in_domain_method_with_a_spread_is_contained_in_extrapolation() -> None:
    data = shell_calibration(88)
    wide = data.deployed.new[None, ..., None] + np.array([-1e3, 5e2])
    wide = np.broadcast_to(wide, (3, *wide.shape[1:]))
    plain = intervals(data, LEVELS)
    bounds = intervals(replace(data, in_domain=wide, in_domain_has_spread=True), LEVELS)
    far = is_in_extrapolation(data)
    both = np.stack([np.minimum(plain[..., 0], wide[..., 0]), np.maximum(plain[..., 1], wide[..., 1])], axis=-1)
    np.testing.assert_array_equal(bounds[:, far], both[:, far])


def process(train: Samples) -> Any:
    params = {"kernel": "rbf", "trend": "linear", "max_iter": 15}
    return fitted_model(MODELS["gp"], FitSettings(params, skip_constant=True, seed=0, threads=1), train)


def coverage_of_a_noisy_arm(seed: int) -> list[float]:
    """Of the method and of split conformal prediction, in extrapolation at 90 %."""
    train, validation = (bending_arm(150, seed=10 * seed + place) for place in (0, 1))
    far = bending_arm(300, seed=10 * seed + 2, largest_command=1.6)
    norm, whole = command_norm(train.commands, standardised=False).of, process(train)
    shells = []
    for core, shell in outer_shells(norm(train.commands), (0.6, 0.7, 0.8, 0.9)):
        predicted = process(Samples(train.commands[core], train.positions[core])).predict(train.commands[shell])
        shells.append(Shell(train.commands[core], train.commands[shell], predicted, train.positions[shell]))
    points = PointCalibration(
        whole.predict(validation.commands),
        validation.positions,
        whole.predict(far.commands),
        train_commands=train.commands,
        calibration_commands=validation.commands,
        new_commands=far.commands,
    )
    data = ShellCalibration(points, shells, norm)
    both = [intervals(data, [0.9])[0], INTERVAL_METHODS["scp_mapie"].intervals(points, [0.9])[0]]
    return [float(covered(far.positions, bounds)[is_in_extrapolation(data)].mean()) for bounds in both]


def test_a_noisy_arm_is_covered_far_oftener_than_by_split_conformal_prediction() -> None:
    """Mean over 10 arms, a Gaussian process each: noise hides how errors grow, so that 90 % is nearly reached."""
    ours, split = np.mean([coverage_of_a_noisy_arm(seed) for seed in range(10)], axis=0)
    assert ours > 0.86
    assert split < 0.6


def test_of_rows_like_those_of_train_hardly_any_lies_in_extrapolation() -> None:
    """At most 2 / (n + 1) of them on average, over 400 draws of 30 rows and 20 new ones."""
    data, n, n_new = shell_calibration(88), 30, 20
    rng, counts = np.random.default_rng(1), []
    for _ in range(400):
        rows = rng.uniform(-1, 1, (n + n_new, 2))
        deployed = replace(data.deployed, train_commands=rows[:n], new_commands=rows[n:])
        counts.append(is_in_extrapolation(replace(data, deployed=deployed)).mean())
    mean, error = np.mean(counts), np.std(counts) / np.sqrt(len(counts))
    assert 0 < mean <= 2 / (n + 1) + 3 * error


def test_a_command_in_a_hole_of_train_is_in_extrapolation() -> None:
    data = shell_calibration(88)
    train = data.deployed.train_commands
    centre = np.zeros_like(data.deployed.new_commands)
    whole = replace(data, deployed=replace(data.deployed, new_commands=centre))
    ring = replace(data, deployed=replace(whole.deployed, train_commands=train[data.norm(train) > 0.5]))
    assert not is_in_extrapolation(whole)[0]
    assert is_in_extrapolation(ring)[0]
