from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.calibration_data import Shell, ShellCalibration
from softkin.uncertainty.error_growth import (
    ErrorGrowth,
    fit_error_growth,
    growth_coefficients,
    new_distances,
    shell_distances,
    train_radius,
)
from tests.unit.uncertainty.conftest import deployed_at, norm, shell_calibration, shells_with_growing_errors


def test_distances_are_norms_in_units_of_the_core_and_of_train() -> None:
    data = shell_calibration(88)
    train, new = data.deployed.train_commands, data.deployed.new_commands
    radius = train_radius(data)
    assert radius == norm(train).max()
    np.testing.assert_allclose(new_distances(data), np.maximum(norm(new) / radius, 1.0))
    for shell, (core, distances) in zip(data.shells, shell_distances(data), strict=True):
        assert 0 < core < 1
        assert (distances > 1).all()
        np.testing.assert_allclose(distances * core * radius, norm(shell.commands))


def test_the_model_is_found_that_the_errors_follow() -> None:
    data = shells_with_growing_errors(3.0, 5.0, np.zeros((1, 2)))
    for growth in fit_error_growth(data):
        np.testing.assert_allclose(growth.core_exponent, 3.0, atol=1.0)
        one, three = (np.log(growth.of_shell(1.0, np.exp([x]))[0]) for x in (0.1, 0.3))
        np.testing.assert_allclose((three - one) / 0.2, 5.0, atol=1.5)


def test_of_two_models_one_has_coefficients_that_all_coordinates_share() -> None:
    own, shared = fit_error_growth(shells_with_growing_errors(3.0, 5.0, np.zeros((1, 2))))
    assert own.slope[0] != own.slope[1]
    assert shared.slope[0] == shared.slope[1]
    assert shared.core_exponent.shape == shared.bend.shape == (2,)


def test_a_bent_growth_is_found_and_continues_as_steeply_as_it_got_there() -> None:
    """A polynomial's errors grow as Chebyshev's, not as a power: cosh(n arccosh(distance))."""
    train = np.random.default_rng(0).uniform(-1, 1, (2000, 2))
    norms, shells = norm(train), []
    for radius in (0.6, 0.8, 1.0):
        core, commands = train[norms <= radius], train[norms > radius]
        distances = norm(commands) / norm(core).max()
        errors = np.cosh(6 * np.arccosh(distances))[:, None] * [1.0, 1.0]
        shells.append(Shell(core, commands, errors, np.zeros_like(errors)))
    data = ShellCalibration(deployed_at(train, np.array([[1.45, 0.0]])), shells, norm)
    for growth in fit_error_growth(data):
        assert (growth.bend < 0).all()
        grown = np.log(growth.of_shell(1.0, np.array([1.1, 1.5]))[:, 0])
        true = 6 * np.arccosh([1.1, 1.5])
        assert grown[1] - grown[0] == pytest.approx(true[1] - true[0], abs=0.7)
        edge = growth.largest_log_distance + np.array([-1e-6, 0.0, 1e-6])
        steps = np.log(growth.of_shell(1.0, np.exp(edge)))[:, 0]
        assert steps[2] - steps[1] == pytest.approx(steps[1] - steps[0], rel=1e-3)
        assert steps[2] > steps[1]


def test_a_model_is_never_taken_for_better_than_the_best_that_was_measured() -> None:
    growth = ErrorGrowth(
        np.array([-4.0, 4.0]), np.array([2.0, 0.0]), np.zeros(2), largest_core=0.5, largest_log_distance=0.1
    )
    np.testing.assert_allclose(growth.of_shell(0.5, np.array([1.0, 2.0])), [[16.0, 1 / 16], [64.0, 1 / 16]])
    np.testing.assert_allclose(growth.of_new(np.array([1.0, 2.0])), [[16.0, 1.0], [64.0, 1.0]])


def test_errors_that_shrink_with_the_distance_are_taken_for_constant() -> None:
    log_cores = np.repeat([-1.0, -0.5], 50)
    log_distances = np.tile(np.linspace(0.01, 0.5, 50), 2)
    errors = np.exp(2 * log_cores - 3 * log_distances)
    core_exponent, slope, bend = growth_coefficients(errors, log_cores, log_distances, np.ones(100))
    assert slope == bend == 0.0
    assert core_exponent == pytest.approx(2.0)


def test_gross_errors_do_not_bend_the_growth() -> None:
    """1 % of rows stuck in another pose, 1000 times off, anywhere in the shells."""
    rng = np.random.default_rng(5)
    log_cores, log_distances = np.log(rng.choice([0.6, 0.7, 0.8, 0.9], 1000)), rng.uniform(0, 0.4, 1000)
    errors = np.abs(rng.standard_normal(1000)) * np.exp(2 * log_cores + 6 * log_distances)
    clean = growth_coefficients(errors, log_cores, log_distances, np.ones(1000))
    errors[rng.choice(1000, 10, replace=False)] *= 1000
    gross = growth_coefficients(errors, log_cores, log_distances, np.ones(1000))

    def grown(coefficients: tuple[float, float, float]) -> float:
        return coefficients[1] * 0.4 + coefficients[2] * 0.4**2

    assert grown(clean) == pytest.approx(6 * 0.4, abs=0.3)
    assert grown(gross) == pytest.approx(grown(clean), abs=0.3)
    assert gross[0] == pytest.approx(clean[0], abs=0.7)


def test_of_one_core_no_exponent_is_made_of_rounding() -> None:
    """It would be a multiple of what the last digits of the errors are, and differ from processor to processor."""
    rng = np.random.default_rng(8)
    log_distances = rng.uniform(0.0, 0.7, 300)
    errors = np.exp(1.5 * log_distances) * rng.exponential(size=300)
    log_cores = np.full(300, np.log(0.7))
    exponent, slope, bend = growth_coefficients(errors, log_cores, log_distances, np.ones(300))
    assert exponent == 0.0
    again = growth_coefficients(errors * (1 + 2e-16), log_cores, log_distances, np.ones(300))
    np.testing.assert_allclose(again, (exponent, slope, bend), rtol=0, atol=1e-11)
