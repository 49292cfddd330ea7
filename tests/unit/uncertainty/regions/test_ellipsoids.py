from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import chi2

from softkin.uncertainty.regions import REGION_METHODS
from softkin.uncertainty.regions.ellipsoids import METHOD
from tests.unit.uncertainty.regions.conftest import ONE_MARKER, on_a_sphere


def test_the_size_is_the_side_of_the_cube_of_equal_volume() -> None:
    """Known residuals of one marker: all of length 3 mm."""
    rows = on_a_sphere(5000, 3.0)
    ball = (4 / 3 * np.pi) ** (1 / 3) * 3.0
    assert METHOD.region(rows, rows, ONE_MARKER, 0.9).size_mm == pytest.approx(ball, rel=0.02)


def test_it_is_the_smallest_where_errors_are_normal_and_correlated() -> None:
    rng = np.random.default_rng(0)
    rows = rng.standard_normal((4000, 3)) @ np.array([[1.0, 0.95, 0.9], [0, 0.1, 0.1], [0, 0, 0.05]])
    sizes = {name: m.region(rows[:1000], rows[1000:], ONE_MARKER, 0.9).size_mm for name, m in REGION_METHODS.items()}
    assert min(sizes, key=lambda name: sizes[name]) == "joint_ellipsoids"
    moments = rows.T @ rows / len(rows)
    volume = 4 / 3 * np.pi * np.sqrt(np.linalg.det(moments)) * chi2.ppf(0.9, 3) ** 1.5
    assert sizes["joint_ellipsoids"] == pytest.approx(volume ** (1 / 3), rel=0.03)
