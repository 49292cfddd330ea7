from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

from softkin.core.samples import Array
from softkin.uncertainty.bounded_squares import MOST_EVALUATIONS, Problems
from tests.recorded_robot import bent


def position(shares: Array) -> Array:
    """Of an arm of two commands from -1.5 to 1.5, in units of its reach."""
    return np.asarray(bent(3 * shares - 1.5)) / 100.0


def problems(targets: Array, near: Array | None = None, enough: float = 1e-9) -> Problems:
    held, weight = (np.zeros((len(targets), 2)), 0.0) if near is None else (near, 1e-2)
    return Problems(position, targets, held, np.full(len(targets), weight), enough, np.zeros(len(targets)))


@pytest.mark.parametrize("noise", [0.0, 0.02, 0.5])
def test_solutions_are_as_near_as_those_of_scipy(noise: float) -> None:
    """Targets that are reached, that nothing reaches, and that are far beyond the bounds."""
    rng = np.random.default_rng(0)
    shares, starts = rng.uniform(0, 1, (60, 2)), rng.uniform(0, 1, (60, 2))
    targets = position(shares) + noise * rng.standard_normal((60, 3))
    found, missing = problems(targets).solved(starts)
    np.testing.assert_allclose(missing, position(found) - targets, atol=1e-15)
    assert ((found >= 0) & (found <= 1)).all()
    reached = np.linalg.norm(position(found) - targets, axis=1)
    scipy = [
        least_squares(lambda x, t=target: position(x[None])[0] - t, start, bounds=(0, 1), xtol=1e-9, ftol=1e-9)
        for target, start in zip(targets, starts, strict=True)
    ]
    best = np.array([np.sqrt(2 * fit.cost) for fit in scipy])
    assert (reached <= best + 1e-4).mean() >= 0.95
    assert np.median(reached - best) <= 1e-7


def test_one_problem_is_solved_as_among_many() -> None:
    rng = np.random.default_rng(1)
    targets, starts = position(rng.uniform(0, 1, (9, 2))), rng.uniform(0, 1, (9, 2))
    many, _ = problems(targets).solved(starts)
    for row in range(9):
        np.testing.assert_allclose(problems(targets[[row]]).solved(starts[[row]])[0][0], many[row], atol=1e-6)
    none, missing = problems(targets[:0]).solved(starts[:0])
    assert none.shape == (0, 2)
    assert missing.shape == (0, 3)


def test_a_solution_is_held_near_a_point_where_nothing_else_decides() -> None:
    def first_alone(shares: Array) -> Array:
        return shares[:, :1]

    near = np.array([[0.2, 0.7]])
    problem = Problems(first_alone, np.array([[0.5]]), near, np.array([1e-3]), 1e-9, np.zeros(1))
    np.testing.assert_allclose(problem.solved(np.array([[0.1, 0.1]]))[0], [[0.5, 0.7]], atol=1e-4)


def test_caution_keeps_what_has_no_effect_near_the_start() -> None:
    """The second number has an effect that is a millionth of the first's, and rounding could drive it anywhere."""

    def hardly(shares: Array) -> Array:
        return np.column_stack([shares[:, 0] ** 2, 1e-6 * np.sin(40 * shares[:, 1])])

    start, targets = np.array([[0.9, 0.4]]), hardly(np.array([[0.3, 0.8]]))
    problem = Problems(hardly, targets, start, np.zeros(1), 1e-7, np.full(1, 1e-6))
    ends, missing = problem.solved(start)
    np.testing.assert_allclose(ends, [[0.3, 0.4]], atol=1e-3)
    assert np.abs(missing[:, 0]).max() <= 1e-5


def test_a_problem_ends_where_it_is_near_enough_and_after_so_many_evaluations() -> None:
    calls: list[int] = []

    def counted(shares: Array) -> Array:
        calls.append(len(shares))
        return position(shares)

    start = np.full((1, 2), 0.5)
    near, _ = Problems(counted, position(start) + 1e-4, start, np.zeros(1), 1.0, np.zeros(1)).solved(start)
    assert calls == [1, 2, 1]
    assert np.linalg.norm(near - start) < 0.01

    def rough(shares: Array) -> Array:
        calls.append(len(shares))
        return np.random.default_rng(len(calls)).uniform(1.0, 2.0, (len(shares), 3))

    calls.clear()
    Problems(rough, np.zeros((1, 3)), start, np.zeros(1), 0.0, np.zeros(1)).solved(start)
    assert sum(calls) <= 3 * MOST_EVALUATIONS
