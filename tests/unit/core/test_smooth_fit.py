from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import softkin.core.rows
from softkin.core.smooth_fit import MAX_TERMS, ROWS_PER_TERM, degree_for, fit_smoothly


def test_a_polynomial_is_recovered_through_outliers() -> None:
    rng = np.random.default_rng(0)
    commands = rng.uniform(-3, 5, (400, 2))
    clean = np.column_stack([commands[:, 0] ** 2 - commands[:, 1], 10 * commands[:, 0] * commands[:, 1]])
    noisy = clean + 0.01 * rng.standard_normal(clean.shape)
    noisy[::20] += 50.0
    fit = fit_smoothly(commands, noisy, np.arange(400))
    residuals = fit.residuals(commands, noisy)
    assert np.abs(residuals[::20] - 50).max() < 0.1
    assert fit.scale == pytest.approx([0.01, 0.01], rel=0.25)
    assert (
        np.abs(np.delete(residuals, np.s_[::20], axis=0)) < fit.limits(np.delete(commands, np.s_[::20], 0), 6)
    ).all()


def test_the_limit_grows_where_rows_are_few() -> None:
    rng = np.random.default_rng(0)
    commands = rng.uniform(-1, 1, (300, 1))
    fit = fit_smoothly(commands, np.sin(commands) + 0.01 * rng.standard_normal((300, 1)), np.arange(300))
    middle, beyond = fit.limits(np.array([[0.0], [2.0]]), 5)
    assert beyond[0] > 20 * middle[0]


def test_the_leverage_is_that_of_least_squares() -> None:
    commands = np.random.default_rng(0).uniform(-1, 1, (100, 2))
    fit = fit_smoothly(commands, commands, np.arange(100))
    terms = fit._terms(commands)
    hat = terms @ np.linalg.solve(terms.T @ terms, terms.T)
    np.testing.assert_allclose(np.square(terms @ fit.root).sum(axis=1), np.diag(hat), rtol=1e-9)


def test_a_command_that_never_varies_does_no_harm() -> None:
    commands = np.column_stack([np.linspace(-1, 1, 100), np.full(100, 0.3)])
    fit = fit_smoothly(commands, commands[:, :1] ** 3, np.arange(100))
    assert np.abs(fit.residuals(commands, commands[:, :1] ** 3)).max() < 1e-9


def test_a_coordinate_that_does_not_move_but_for_a_few_rows_has_an_extent() -> None:
    positions = np.zeros((100, 1))
    positions[50] = 4.0
    assert fit_smoothly(np.linspace(-1, 1, 100)[:, None], positions, np.arange(100)).extent == [4.0]


@given(st.integers(0, 10_000), st.integers(1, 64))
def test_the_degree_leaves_enough_rows_for_its_terms(n_rows: int, n_commands: int) -> None:
    from math import comb

    degree = degree_for(n_rows, n_commands)
    terms = comb(n_commands + degree, degree)
    assert 0 <= degree <= 8
    assert degree <= 1 or terms <= min(MAX_TERMS, n_rows / ROWS_PER_TERM)
    assert degree == 0 or n_rows >= 3 * terms


def test_residuals_do_not_depend_on_the_chunk(monkeypatch: pytest.MonkeyPatch) -> None:
    commands = np.random.default_rng(0).uniform(-1, 1, (50, 2))
    fit = fit_smoothly(commands, np.sin(commands), np.arange(50))
    whole = fit.residuals(commands, np.sin(commands))
    monkeypatch.setattr(softkin.core.rows, "CHUNK", 7)
    np.testing.assert_allclose(fit.residuals(commands, np.sin(commands)), whole, atol=1e-12)
