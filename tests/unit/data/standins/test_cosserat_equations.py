"""The equations of the rod: what is given at the base, and integration along the rod."""

from __future__ import annotations

import math

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.data.standins.cosserat_equations import M, N, Q, R, T, base_states, cross, march
from softkin.data.standins.rod import Loads, Rod, disc, loads, section

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
TENDONS = ((8.0, 0.0), (-8.0, 0.0))
ROD = Rod(120.0, *section(7.0, *disc(10.0)), tendons=TENDONS)
#: Bends and twists, but neither stretches nor shears.
STIFF = Rod(100.0, (1e12,) * 3, (1e5,) * 3)


def marched(rod: Rod, of_rows: Loads, moments: Array, n_steps: int = 24) -> Array:
    """States (n_stations, n_state, n_rows) from the base to the tip."""
    start = base_states(rod, of_rows, UPRIGHT, moments)
    return np.stack(march(rod, of_rows, start, rod.length / n_steps, n_steps))


def test_the_base_is_clamped_and_carries_all_forces() -> None:
    of_rows = loads(
        ROD, 2, tip_force=(1.0, 2.0, 3.0), distributed_force=(0.0, 0.0, -0.1), tensions=np.array([[5.0, 6.0]] * 2)
    )
    moments = np.arange(6.0).reshape(3, 2)
    state = base_states(ROD, of_rows, UPRIGHT, moments)
    assert state.shape == (15, 2)
    assert (state[R] == 0).all()
    assert state[Q].T.tolist() == [UPRIGHT.tolist()] * 2
    np.testing.assert_allclose(state[N].T, [[1.0, 2.0, 3.0 - 12.0]] * 2)
    np.testing.assert_array_equal(state[M], moments)
    assert state[T].T.tolist() == [[5.0, 6.0]] * 2


def test_without_loads_the_rod_is_straight() -> None:
    states = marched(ROD, loads(ROD, 1), np.zeros((3, 1)), n_steps=6)
    np.testing.assert_allclose(states[:, R, 0], [[0, 0, 20 * step] for step in range(7)], atol=1e-12)
    np.testing.assert_array_equal(states[:, Q, 0], [UPRIGHT] * 7)


def test_a_moment_bends_to_an_arc() -> None:
    angle = 1.2
    of_rows = loads(STIFF, 1, tip_moment=(0.0, angle * 1e5 / 100.0, 0.0))
    states = marched(STIFF, of_rows, of_rows.tip_moment.T, n_steps=48)
    turned = np.linspace(0, angle, 49)
    arc = np.stack([1 - np.cos(turned), 0 * turned, np.sin(turned)], axis=1) * 100.0 / angle
    np.testing.assert_allclose(states[:, R, 0], arc, atol=1e-6)
    half = states[-1, Q, 0]
    assert 2 * math.atan2(half[2], half[0]) == pytest.approx(angle, abs=1e-7)


def test_forces_and_moments_balance_along_the_rod() -> None:
    """n falls to the tip force, and m changes by the arm of n: m' = -r' x n."""
    force, weight = np.array([0.02, -0.01, 0.03]), np.array([0.0, 1e-4, -2e-4])
    of_rows = loads(STIFF, 1, tip_force=force, distributed_force=weight)
    states = marched(STIFF, of_rows, np.array([[1.0], [2.0], [0.5]]), n_steps=96)[..., 0]
    np.testing.assert_allclose(states[-1, N], force, atol=1e-12)
    steps, middles = np.diff(states[:, R], axis=0), (states[1:, N] + states[:-1, N]) / 2
    np.testing.assert_allclose(states[-1, M] - states[0, M], -np.cross(steps, middles).sum(axis=0), atol=1e-5)


def test_marching_back_leads_back_to_the_base() -> None:
    of_rows = loads(ROD, 1, tip_force=(0.2, 0.1, 0.0), tensions=np.array([[10.0, 3.0]]))
    moments = np.array([[10.0], [-20.0], [5.0]])
    states = marched(ROD, of_rows, moments, n_steps=48)
    back = march(ROD, of_rows, states[-1], -ROD.length / 48, 48)
    np.testing.assert_allclose(back[-1][:, 0], states[0][:, 0], atol=1e-5)


def test_friction_takes_tension_away_in_the_direction_of_sliding() -> None:
    rubbing = Rod(120.0, *section(7.0, *disc(10.0)), tendons=TENDONS, friction=0.3)
    of_rows = loads(rubbing, 3, tensions=20.0, slides=np.array([[1.0], [0.0], [-1.0]]))
    tensions = marched(rubbing, of_rows, np.array([[0.0], [2000.0], [0.0]]) * np.ones(3))[-1, T]
    assert (tensions[:, 0] < 20.0).all()
    np.testing.assert_array_equal(tensions[:, 1], 20.0)
    assert (tensions[:, 2] > 20.0).all()


def test_a_row_whose_tendons_find_no_direction_is_left_unsolved() -> None:
    limp = Rod(120.0, (1e3,) * 3, (5e4, 5e4, 50.0), tendons=((8.0, 0.0), (0.0, 8.0)))
    of_rows = loads(limp, 2, tip_force=(0.1, 0.1, 0.0), tensions=np.array([[0.0], [500.0]]))
    with np.errstate(all="ignore"):
        tip = marched(limp, of_rows, np.array([[1.0], [1.0], [1.0]]) * np.ones(2), n_steps=8)[-1]
    assert np.isfinite(tip[:, 0]).all()
    assert np.isnan(tip[R, 1]).any()


def test_the_cross_product_is_numpys() -> None:
    a, b = np.random.default_rng(0).standard_normal((2, 3, 7))
    np.testing.assert_allclose(cross(a, b), np.cross(a.T, b.T).T)
