from __future__ import annotations

import math

import numpy as np
import pytest

from softkin.uncertainty.regions.balls import METHOD, SCALED, marker_errors
from softkin.uncertainty.regions.spec import RegionMethod, log_ball_volume
from tests.unit.uncertainty.regions.conftest import MARKERS, ONE_MARKER, on_a_sphere, residuals


def test_the_error_of_a_marker_is_the_length_of_its_residual() -> None:
    rows = np.array([[3.0, 4.0, 1.0], [0.0, 2.0, -6.0]])
    assert marker_errors(rows, np.array([0, 0, 4])).tolist() == [[5.0, 1.0], [2.0, 6.0]]


def test_volumes_of_unit_balls() -> None:
    volumes = np.exp(log_ball_volume(np.array([1.0, 2.0, 3.0])))
    assert volumes.tolist() == pytest.approx([2.0, math.pi, 4 / 3 * math.pi])


@pytest.mark.parametrize("method", [METHOD, SCALED])
def test_the_size_is_the_side_of_the_cube_of_equal_volume(method: RegionMethod) -> None:
    """Known residuals of one marker: all of length 3 mm."""
    rows = on_a_sphere(5000, 3.0)
    ball = (4 / 3 * np.pi) ** (1 / 3) * 3.0
    assert method.region(rows, rows, ONE_MARKER, 0.9).size_mm == pytest.approx(ball, rel=0.02)


def test_a_radius_per_marker_is_smaller_where_errors_differ() -> None:
    rows = residuals(400, 0)
    one, scaled = (method.region(rows[:200], rows[200:], MARKERS, 0.9) for method in (METHOD, SCALED))
    assert scaled.size_mm < 0.5 * one.size_mm
    off = np.array([[9.0, 0, 0, 0, 0, 0]])  # nine times the errors of the first marker, and fewer than the second's
    assert one.covers(off).all()
    assert not scaled.covers(off).any()
