from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from softkin.core.geometry.base_frame import BaseFrame, base_frame, markers_at_the_base
from softkin.core.geometry.constant_curvature import from_arcs
from tests.conftest import HOUSE


def unit(vector: list[float]) -> np.ndarray:
    return np.array(vector) / np.linalg.norm(vector)


def bent(
    frame: BaseFrame, *, n_markers: int = 1, n_rows: int = 200, noise: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Commands and markers of a robot that bends in arcs, in proportion to its commands; 100 mm long."""
    rng = np.random.default_rng(1)
    commands = rng.uniform(-1, 1, (n_rows, 2))
    share = np.arange(1, n_markers + 1) / n_markers
    arcs = np.stack(
        [
            np.outer(1.4 * commands[:, 0], share),
            np.outer(0.9 * commands[:, 1], share),
            np.tile(100 * share, (n_rows, 1)),
        ],
        axis=-1,
    )
    points = frame.from_base(from_arcs(arcs))
    return commands, points + noise * rng.standard_normal(points.shape)


vectors = st.lists(st.floats(-1, 1), min_size=3, max_size=3).filter(lambda v: np.linalg.norm(v) > 0.1)


@given(vectors, vectors)
@example([0.0, 0.0, 1.0], [0.0, 7.8e-162, -1.0])
def test_points_come_back_from_the_frame_of_the_base(origin: list[float], axis: list[float]) -> None:
    frame = BaseFrame(np.array(origin), unit(axis))
    points = np.random.default_rng(0).uniform(-50, 50, (6, 2, 3))
    np.testing.assert_allclose(frame.from_base(frame.to_base(points)), points, atol=1e-12)
    np.testing.assert_allclose(frame.to_base(frame.origin + 7 * frame.axis), [0, 0, 7], atol=1e-12)


@pytest.mark.parametrize("axis", [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, -2.0, 0.5]])
@pytest.mark.parametrize("n_markers", [1, 3])
def test_origin_and_axis_are_estimated_where_nothing_is_declared(axis: list[float], n_markers: int) -> None:
    true = BaseFrame(np.array([30.0, -400.0, 12.0]), unit(axis))
    frame = base_frame(*bent(true, n_markers=n_markers, n_rows=80))
    np.testing.assert_allclose(frame.origin, true.origin, atol=1e-3)
    np.testing.assert_allclose(frame.axis, true.axis, atol=1e-5)


def test_what_was_estimated_from_the_same_rows_is_cached(monkeypatch: pytest.MonkeyPatch) -> None:
    true = [BaseFrame(np.array([1.0, 2.0, z]), unit([0.1, 0.0, 1.0])) for z in (3.0, 4.0)]
    robots = [bent(frame, n_rows=90) for frame in true]
    frames = [base_frame(*robot) for robot in robots]
    assert frames[0].origin[2] == pytest.approx(3.0, abs=1e-3)
    assert frames[1].origin[2] == pytest.approx(4.0, abs=1e-3)
    monkeypatch.setattr("softkin.core.geometry.base_frame.least_squares", None)
    for robot, frame in zip(robots, frames, strict=True):
        assert base_frame(*robot) == frame
    with pytest.raises(TypeError):  # other rows are estimated anew
        base_frame(robots[0][0][1:], robots[0][1][1:])


@pytest.mark.parametrize("seed", range(5))
def test_noise_and_some_gross_outliers_hardly_move_the_base(seed: int) -> None:
    true = BaseFrame(np.array([5.0, 6.0, 7.0]), unit([0.3, 0.1, 1.0]))
    commands, points = bent(true, noise=0.2)
    outliers = np.random.default_rng(seed).choice(len(points), 6, replace=False)
    points[outliers] += 40.0
    frame = base_frame(commands, points)
    assert np.linalg.norm(frame.origin - true.origin) < 4
    assert frame.axis @ true.axis > np.cos(0.05)


def test_what_is_declared_stays_and_the_rest_is_estimated() -> None:
    true = BaseFrame(np.array([0.0, 0.0, 25.0]), np.array([0.0, 0.0, 1.0]))
    commands, points = bent(true)
    depth = base_frame(commands, points, {"origin": [0.0, 0.0, None], "axis": [0.0, 0.0, 2.0]})
    np.testing.assert_allclose(depth.origin, true.origin, atol=1e-4)
    assert depth.origin[0] == 0
    np.testing.assert_array_equal(depth.axis, true.axis)
    whole = base_frame(commands, points, {"origin": [1.0, 2.0, 3.0], "axis": [0.0, 1.0, 0.0]})
    np.testing.assert_array_equal(whole.origin, [1, 2, 3])


def test_a_marker_that_never_moves_is_the_base() -> None:
    true = BaseFrame(np.array([-36.0, -45.0, 0.0]), unit([0.1, 0.0, 1.0]))
    commands, points = bent(true, n_markers=2)
    constant = np.tile(true.origin, (len(points), 1, 1))
    frame = base_frame(commands, np.concatenate([constant, points], axis=1))
    np.testing.assert_array_equal(frame.origin, true.origin)
    np.testing.assert_allclose(frame.axis, true.axis, atol=1e-5)


def test_case_31_a_marker_that_hardly_moves_is_the_base() -> None:
    table = np.loadtxt(next((HOUSE / "tests" / "cases").glob("31_*.csv")), delimiter=",", skiprows=1)
    points = 1000 * table[:, 3:].reshape(len(table), 3, 3)
    assert markers_at_the_base(points).tolist() == [True, False, False]
    frame = base_frame(table[:, 1:3], points)
    np.testing.assert_allclose(frame.origin, points[:, 0].mean(axis=0), atol=0.05)
    assert frame.refused_mm is None


def test_the_first_marker_of_an_evenly_marked_arm_is_no_base() -> None:
    bends = np.random.default_rng(0).uniform(-0.5, 0.5, (100, 1))
    along = np.arange(1.0, 11.0) * 20
    points = np.stack([along**2 / 400 * bends, 0 * along * bends, along + 0 * bends], axis=-1)
    assert not markers_at_the_base(points).any()


def test_an_estimate_out_of_reach_is_not_used() -> None:
    """Markers that are shifted as a whole bend around a base at infinity."""
    rng = np.random.default_rng(0)
    commands = rng.uniform(-1, 1, (100, 2))
    shifts = np.column_stack([5 * commands, np.zeros(100)]) + 0.01 * rng.standard_normal((100, 3))
    points = shifts[:, None] + np.array([[0, 0, 0], [0, 0, 5.0]])
    frame = base_frame(commands, points)
    assert frame.refused_mm is not None
    reach = np.linalg.norm(points[:, 0] - points[:, 1], axis=1).max()
    assert frame.refused_mm > reach
    assert np.linalg.norm(points - frame.origin, axis=2).min() <= 1.5 * reach


def test_a_planar_robot_has_its_base_in_its_plane() -> None:
    rng = np.random.default_rng(0)
    commands = rng.uniform(-1, 1, (100, 1))
    arcs = np.stack([1.5 * commands, 0 * commands, 0 * commands + 60], axis=-1)
    true = BaseFrame(np.array([4.0, -9.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    x, _, z = np.moveaxis(from_arcs(arcs), -1, 0)
    points = np.stack([4 + z, -9 + x, 0 * x], axis=-1)
    frame = base_frame(commands, points)
    np.testing.assert_allclose(frame.origin, true.origin, atol=1e-3)
    np.testing.assert_allclose(frame.axis, true.axis, atol=1e-5)
    assert frame.origin[2] == frame.axis[2] == 0
