from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from softkin.core.geometry.constant_curvature import MAX_BENDING, _sinc, from_arcs, has_arc, spread_of_points, to_arcs

lengths = st.floats(1e-3, 1e4)
directions = st.floats(-np.pi, np.pi)
#: Straight, nearly straight, bent past 180 degrees.
bendings = st.one_of(st.just(0.0), st.floats(1e-12, 1e-6), st.floats(1e-6, MAX_BENDING))


def arc(bending: float, direction: float, length: float) -> np.ndarray:
    return np.array([[[bending * np.cos(direction), bending * np.sin(direction), length]]])


@given(bendings, directions, lengths)
def test_an_arc_comes_back_from_the_point_that_it_leads_to(bending: float, direction: float, length: float) -> None:
    q = arc(bending, direction, length)
    # Near a full turn the point lies close to the base: what is left of its digits decides.
    np.testing.assert_allclose(to_arcs(from_arcs(q)), q, rtol=1e-9, atol=1e-9)


@given(st.floats(-500, 500), st.floats(-500, 500), st.floats(-500, 500))
def test_a_point_comes_back_from_its_arc(x: float, y: float, z: float) -> None:
    points = np.array([[[x, y, z]]])
    if has_arc(points).all():
        np.testing.assert_allclose(from_arcs(to_arcs(points)), points, rtol=1e-9, atol=1e-9)


@given(bendings.filter(lambda b: b > 0.01), directions, lengths)
def test_an_arc_is_where_its_differential_equation_leads(bending: float, direction: float, length: float) -> None:
    """The tangent turns steadily from z towards the direction of bending: integrated by the midpoint rule."""
    steps = (np.arange(20_000) + 0.5) / 20_000
    tangent = np.stack(
        [
            np.sin(bending * steps) * np.cos(direction),
            np.sin(bending * steps) * np.sin(direction),
            np.cos(bending * steps),
        ]
    )
    np.testing.assert_allclose(
        from_arcs(arc(bending, direction, length))[0, 0], length * tangent.mean(axis=1), atol=1e-7 * length
    )


def test_the_base_itself_and_what_lies_straight_behind_it_have_no_arc() -> None:
    points = np.array([[[0.0, 0.0, 0.0]], [[0.0, 0.0, -3.0]], [[0.0, 1.0, -3.0]], [[0.0, 0.0, 3.0]]])
    np.testing.assert_array_equal(has_arc(points)[:, 0], [False, False, True, True])


def test_the_spread_of_points_is_that_of_a_cloud_of_arcs() -> None:
    rng = np.random.default_rng(0)
    for q in (arc(0.0, 0.0, 100.0), arc(1.2, 0.4, 80.0), arc(4.0, -2.0, 50.0)):
        spread = np.array([[[0.002, 0.003, 0.1]]])
        cloud = from_arcs(q + spread * rng.standard_normal((200_000, 1, 3)))[:, 0]
        turned = np.linalg.qr(rng.standard_normal((3, 3)))[0]
        np.testing.assert_allclose(spread_of_points(q, spread, turned)[0, 0], (cloud @ turned).std(axis=0), rtol=0.02)


@pytest.mark.parametrize("bending", [0.0, 1e-7, 0.1, 0.2999, 0.3001, 0.6, 2.0, 5.0])
def test_spreads_follow_the_slopes_of_finite_differences(bending: float) -> None:
    arc = np.array([[[0.6 * bending, -0.8 * bending, 80.0]]])
    for axis in range(3):
        step, spread = np.zeros((1, 1, 3)), np.zeros((1, 1, 3))
        step[..., axis], spread[..., axis] = 1e-5, 0.1
        slope = (from_arcs(arc + step) - from_arcs(arc - step)) / 2e-5
        np.testing.assert_allclose(spread_of_points(arc, spread, np.eye(3)), np.abs(slope) * 0.1, atol=1e-8)


def test_the_sine_by_its_angle_is_that_of_numpy_to_the_bit() -> None:
    angles = np.concatenate([[0.0, 1e-300, 1e-9], np.random.default_rng(0).uniform(-7, 7, 500)])
    np.testing.assert_array_equal(_sinc(angles), np.sinc(angles / np.pi))
