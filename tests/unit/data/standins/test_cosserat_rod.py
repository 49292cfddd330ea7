"""The rod against what is known in closed form, and against the equations written in another way."""

from __future__ import annotations

import logging
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, root
from scipy.spatial.transform import Rotation
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from softkin.core.errors import ConfigError
from softkin.core.samples import Array
from softkin.data.standins.cosserat_rod import BATCH, solve
from softkin.data.standins.rod import Rod, disc, loads, section

LENGTH, STIFF = 100.0, 1e5
#: Bends and twists, but neither stretches nor shears.
ELASTICA = Rod(LENGTH, (1e12,) * 3, (STIFF, STIFF, STIFF))
TENDONS = ((8.0, 0.0), (0.0, 8.0), (-8.0, 0.0), (0.0, -8.0))
FINGER = Rod(120.0, *section(7.0, *disc(10.0)), mass_per_length=0.35, tendons=TENDONS)


def tip(rod: Rod, n_elements: int = 24, **load: object) -> Array:
    return solve(rod, loads(rod, 1, **load), n_elements=n_elements).positions[0, -1]  # type: ignore[arg-type]


def test_no_load_no_bend() -> None:
    np.testing.assert_allclose(tip(ELASTICA), [0, 0, LENGTH], atol=1e-11)


def test_small_tip_force_bends_as_a_cantilever() -> None:
    force = 1e-4
    assert tip(ELASTICA, tip_force=(force, 0, 0))[0] == pytest.approx(force * LENGTH**3 / (3 * STIFF), rel=1e-6)


def test_small_weight_bends_as_a_cantilever() -> None:
    weight = 1e-6
    sunk = tip(ELASTICA, distributed_force=(0, -weight, 0))[1]
    assert sunk == pytest.approx(-weight * LENGTH**4 / (8 * STIFF), rel=1e-6)


def test_a_short_beam_also_shears() -> None:
    rod = Rod(10.0, *section(7.0, *disc(5.0)))
    bent = 1e-4 * (rod.length**3 / (3 * rod.bend_stiffness[0]) + rod.length / rod.stretch_stiffness[0])
    assert tip(rod, tip_force=(1e-4, 0, 0))[0] == pytest.approx(bent, rel=1e-6)


@pytest.mark.parametrize("pull", [-5.0, 50.0])
def test_an_axial_force_stretches(pull: float) -> None:
    assert tip(FINGER, tip_force=(0, 0, pull))[2] == pytest.approx(120 * (1 + pull / FINGER.stretch_stiffness[2]))


def test_hanging_it_stretches_by_half_its_weight() -> None:
    rod = replace(FINGER, bend_stiffness=(1e9,) * 3)
    sunk = rod.weight_per_length * 120**2 / (2 * rod.stretch_stiffness[2])
    assert tip(rod, distributed_force=(0, 0, rod.weight_per_length))[2] == pytest.approx(120 + sunk, abs=1e-9)


@pytest.mark.parametrize("angle", [0.3, 1.5, 4.0])
def test_a_tip_moment_bends_to_an_arc(angle: float) -> None:
    shape = solve(ELASTICA, loads(ELASTICA, 1, tip_moment=(0, angle * STIFF / LENGTH, 0)), n_elements=48)
    turned = np.linspace(0, angle, 49)
    arc = np.stack([1 - np.cos(turned), 0 * turned, np.sin(turned)], axis=1) * LENGTH / angle
    np.testing.assert_allclose(shape.positions[0], arc, atol=2e-5)


def elastica_tip(alpha_squared: float) -> tuple[float, float]:
    """Tip (x, z) of an elastica under F = `alpha_squared` EI / L2 across: Bisshopp and Drucker (1945)."""
    alpha = math.sqrt(alpha_squared)

    def start(k: float) -> float:
        return math.asin(1 / (k * math.sqrt(2)))

    k = brentq(lambda k: ellipk(k * k) - ellipkinc(start(k), k * k) - alpha, math.sqrt(0.5), 1 - 1e-15, xtol=1e-15)
    across = 1 - 2 / alpha * (ellipe(k * k) - ellipeinc(start(k), k * k))
    return LENGTH * across, LENGTH * math.sqrt(2 * (2 * k * k - 1)) / alpha


@pytest.mark.parametrize("alpha_squared", [0.1, 1.0, 5.0, pytest.param(10.0, marks=pytest.mark.slow), 15.0])
def test_the_elastica_under_a_tip_force(alpha_squared: float) -> None:
    """From 11 on Newton's method alone lands on an unstable branch: the stable one must come out."""
    reached = tip(ELASTICA, n_elements=32, tip_force=(alpha_squared * STIFF / LENGTH**2, 0, 0))
    np.testing.assert_allclose(reached[[0, 2]], elastica_tip(alpha_squared), atol=2e-4)


def test_a_column_buckles_under_its_weight_where_greenhill_says() -> None:
    critical = 7.8373 * STIFF / LENGTH**3
    assert tip(ELASTICA, distributed_force=(0, 0, -0.995 * critical))[:2].tolist() == [0.0, 0.0]
    with pytest.raises(ConfigError, match=r"row 0: no stable equilibrium[\s\S]*distributed_force[\s\S]*fix:"):
        tip(ELASTICA, distributed_force=(0, 0, -1.005 * critical))


def test_a_column_buckles_under_a_tip_force_where_euler_says() -> None:
    weak = replace(ELASTICA, bend_stiffness=(STIFF, 2 * STIFF, STIFF))  # one plane at a time
    critical = math.pi**2 * STIFF / (4 * LENGTH**2)
    assert tip(weak, tip_force=(0, 0, -0.99 * critical))[:2].tolist() == [0.0, 0.0]
    with pytest.raises(ConfigError, match="no stable equilibrium"):
        tip(weak, tip_force=(0, 0, -1.01 * critical))


def turned_shape(turn: Array, base_rotation: Array | None) -> Array:
    force, moment, weight = np.array([0.2, -0.1, 0.3]), np.array([20.0, 10.0, -30.0]), np.array([0.0, 0.0, -3e-3])
    turned = loads(
        FINGER,
        1,
        tip_force=turn @ force,
        tip_moment=turn @ moment,
        distributed_force=turn @ weight,
        tensions=np.array([20.0, 5.0, 0.0, 10.0]),
    )
    return solve(FINGER, turned, base_rotation=base_rotation).positions[0]


@pytest.fixture(scope="module")
def upright_shape() -> Array:
    return turned_shape(np.eye(3), None)


@settings(max_examples=4, deadline=None)
@given(quaternion=st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: math.hypot(*q) > 0.1))
def test_turning_base_and_loads_turns_the_shape(
    upright_shape: Array, quaternion: tuple[float, float, float, float]
) -> None:
    turn = Rotation.from_quat(quaternion).as_matrix()
    np.testing.assert_allclose(turned_shape(turn, turn), upright_shape @ turn.T, atol=1e-6)


def test_the_error_falls_with_the_fourth_power_of_the_elements() -> None:
    load = {"tip_force": (0.3, -0.2, 0.1), "distributed_force": (0, 0, -3e-3), "tensions": np.array([30.0, 10, 0, 0])}
    exact = tip(FINGER, 96, **load)
    errors = [float(np.linalg.norm(tip(FINGER, n, **load) - exact)) for n in (6, 12, 24)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert ((orders > 3.6) & (orders < 4.4)).all(), (errors, orders)
    assert errors[-1] < 1e-5


def arc(curvature: float, stretch: float, length: float) -> list[float]:
    """Tip (x, z) of a rod of constant curvature (per reference length) and stretch."""
    angle = curvature * length
    return [stretch * (1 - math.cos(angle)) / curvature, stretch * math.sin(angle) / curvature]


def test_one_tendon_alone_bends_to_an_arc() -> None:
    tension = 30.0
    curvature = tension * 8.0 / FINGER.bend_stiffness[1]
    expected = arc(curvature, 1 - tension / FINGER.stretch_stiffness[2], 120.0)
    np.testing.assert_allclose(tip(FINGER, tensions=np.array([tension, 0, 0, 0]))[[0, 2]], expected, atol=1e-5)


def test_one_chamber_alone_bends_away_to_an_arc() -> None:
    rod = Rod(120.0, *section(7.0, *disc(10.0)), chambers=((5.0, 0.0),), chamber_area=20.0)
    push = 0.9 * 20.0
    expected = arc(push * 5.0 / rod.bend_stiffness[1], 1 + push / rod.stretch_stiffness[2], 120.0)
    reached = tip(rod, pressures=0.9)
    np.testing.assert_allclose([-reached[0], reached[2]], expected, atol=1e-5)


@pytest.mark.parametrize("slide", [-1.0, 1.0])
def test_a_rubbing_tendon_obeys_the_capstan_equation(slide: float) -> None:
    """Curvature d T(s) / EI and T' = -slide mu T curvature: the tip turns by ln(1 + slide mu d T0 L / EI) / mu."""
    mu, tension = 0.3, 30.0
    rod = replace(FINGER, friction=mu)
    shape = solve(rod, loads(rod, 1, tensions=np.array([tension, 0, 0, 0]), slides=slide), n_elements=48)
    turned = 2 * math.atan2(shape.quaternions[0, -1, 2], shape.quaternions[0, -1, 0])
    expected = math.log(1 + slide * mu * 8.0 * tension * 120.0 / rod.bend_stiffness[1]) / (slide * mu)
    assert turned == pytest.approx(expected, rel=1e-7)


def hat(v: Array) -> Array:
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def rucker_and_webster_tip(rod: Rod, tensions: list[float], force: Array, weight: Array) -> Array:
    """The tip by the equations as printed, tendons as distributed loads, integrated and shot by scipy."""
    shear, bend = np.diag(rod.stretch_stiffness), np.diag(rod.bend_stiffness)
    offsets, upright = [np.array([*offset, 0.0]) for offset in rod.tendons], np.array([0.0, 0.0, 1.0])

    def rates(_: float, state: Array) -> Array:
        turn, v, u = state[3:12].reshape(3, 3), state[12:15], state[15:18]
        left = np.block([[shear, np.zeros((3, 3))], [np.zeros((3, 3)), bend]])
        right = [-hat(u) @ shear @ (v - upright) - turn.T @ weight]
        right += [-hat(u) @ bend @ u - hat(v) @ shear @ (v - upright)]
        for offset, tension in zip(offsets, tensions, strict=True):
            along = np.cross(u, offset) + v
            a = -tension * hat(along) @ hat(along) / np.linalg.norm(along) ** 3
            b = hat(offset) @ a
            left += np.block([[a, -a @ hat(offset)], [b, -b @ hat(offset)]])
            push = a @ np.cross(u, along)
            right = [right[0] - push, right[1] - np.cross(offset, push)]
        strains = np.linalg.solve(left, np.concatenate(right))
        return np.concatenate([turn @ v, (turn @ hat(u)).ravel(), strains])

    def shoot(strains: Array) -> Array:
        start = np.concatenate([np.zeros(3), np.eye(3).ravel(), strains])
        return np.asarray(solve_ivp(rates, (0, rod.length), start, "DOP853", rtol=1e-8, atol=1e-10).y[:, -1])

    def miss(strains: Array) -> Array:
        end = shoot(strains)
        turn, v, u = end[3:12].reshape(3, 3), end[12:15], end[15:18]
        n, m = shear @ (v - upright) - turn.T @ force, bend @ u
        for offset, tension in zip(offsets, tensions, strict=True):
            along = np.cross(u, offset) + v
            pull = tension * along / np.linalg.norm(along)
            n, m = n + pull, m + np.cross(offset, pull)
        return np.concatenate([n, m / rod.length])

    solution = root(miss, [0, 0, 1, 0, 0, 0], tol=1e-9)
    assert np.abs(solution.fun).max() < 1e-7
    return shoot(solution.x)[:3]


@pytest.mark.slow
def test_tendons_and_loads_agree_with_rucker_and_websters_equations() -> None:
    """Bending out of a plane with twist, where the tendons' paths are no longer parallel to the centreline's normal."""
    force, weight, tensions = np.array([0.4, -0.9, 0.3]), np.array([0.0, 2e-3, -3e-3]), [25.0, 0.0, 0.0, 30.0]
    expected = rucker_and_webster_tip(FINGER, tensions, force, weight)
    reached = tip(FINGER, 96, tip_force=force, distributed_force=weight, tensions=np.array(tensions))
    np.testing.assert_allclose(reached, expected, atol=1e-5)


def test_forces_and_moments_balance_at_the_base() -> None:
    force, weight = np.array([0.2, -0.1, 0.0]), np.array([0.0, 0.0, -3e-3])
    shape = solve(FINGER, loads(FINGER, 1, tip_force=force, distributed_force=weight), n_elements=96)
    np.testing.assert_allclose(shape.forces[0, 0], force + 120 * weight)
    centreline = shape.positions[0]
    middles = (centreline[1:] + centreline[:-1]) / 2
    carried = np.cross(centreline[-1], force) + np.cross(middles, weight * 120 / 96).sum(axis=0)
    np.testing.assert_allclose(shape.moments[0, 0], carried, rtol=1e-5, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(shape.quaternions, axis=-1), 1, rtol=1e-14)


def test_rows_do_not_depend_on_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    progress: list[str] = []
    monkeypatch.setattr(logging.getLogger("softkin"), "info", lambda text, *values: progress.append(text % values))
    rng = np.random.default_rng(0)
    n_rows = BATCH + 3
    every = loads(FINGER, n_rows, tip_force=rng.normal(0, 0.2, (n_rows, 3)), tensions=rng.uniform(0, 30, (n_rows, 4)))
    together = solve(FINGER, every, n_elements=8, label="finger").positions
    assert progress == [f"finger: {BATCH} of {n_rows} rows simulated", f"finger: {n_rows} of {n_rows} rows simulated"]
    for row in (0, BATCH - 1, BATCH, n_rows - 1):
        alone = solve(FINGER, every.rows(np.array([row])), n_elements=8).positions[0]
        np.testing.assert_allclose(together[row], alone, atol=1e-6)


def test_a_row_without_equilibrium_is_named_and_never_returned() -> None:
    """A tendon that twists the rod beyond all bounds, in the third row of the second batch."""
    limp = replace(FINGER, bend_stiffness=(5e4, 5e4, 50.0))
    tensions = np.zeros((BATCH + 4, 4))
    tensions[BATCH + 2] = 200.0
    with pytest.raises(ConfigError, match=rf"row {BATCH + 2}: no stable equilibrium \(1 of 4 rows"):
        solve(limp, loads(limp, BATCH + 4, tip_force=(0.1, 0.1, 0.0), tensions=tensions), n_elements=8)
