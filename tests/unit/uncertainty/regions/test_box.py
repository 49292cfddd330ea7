from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.conformal import error_scale
from softkin.uncertainty.regions.box import METHOD
from tests.unit.uncertainty.regions.conftest import MARKERS, ONE_MARKER, on_a_sphere, residuals


def test_the_size_is_the_side_of_the_cube_of_equal_volume() -> None:
    """Known residuals of one marker: all of length 3 mm."""
    rows = on_a_sphere(5000, 3.0)
    limit = np.sort(np.abs(rows).max(axis=1) / error_scale(np.abs(rows)).mean())[4501]
    box = METHOD.region(rows, rows, ONE_MARKER, 0.9)
    assert box.size_mm == pytest.approx(2 * error_scale(np.abs(rows)).mean() * limit, rel=0.02)


def test_its_sides_are_proportional_to_the_errors_on_train() -> None:
    rows = residuals(400, 0)
    box = METHOD.region(rows[:200], rows[200:], MARKERS, 0.9)
    scale = error_scale(np.abs(rows[:200]))
    halves = []
    for coordinate in range(6):
        steps = np.linspace(0, 10, 2001)
        along = np.outer(steps, np.eye(6)[coordinate] * scale[coordinate])
        halves.append(steps[box.covers(along)].max())
    np.testing.assert_allclose(halves, halves[0], atol=0.006)
