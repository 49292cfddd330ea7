"""Every kind of joint region: what it covers, how large it is, that the law of its coverage is exact."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import chi2

from softkin.core.samples import Array
from softkin.uncertainty.conformal import conformal_rank, error_scale
from softkin.uncertainty.regions import REGION_METHODS

MARKERS = np.array([0, 0, 0, 2, 2, 2])


def residuals(n: int, seed: int) -> Array:
    """Two markers, the second ten times as far off, the coordinates of each correlated."""
    rng = np.random.default_rng(seed)
    mixed = rng.standard_normal((n, 6)) @ (np.eye(6) + 0.5 * np.kron(np.eye(2), np.ones((3, 3))))
    return np.asarray(mixed * np.repeat([1.0, 10.0], 3))


@pytest.mark.parametrize("name", REGION_METHODS)
def test_joint_coverage_over_random_splits_is_what_theory_says(name: str) -> None:
    """300 times 88 calibration and 89 new rows: the mean is k / (n + 1) within 4 standard errors."""
    method, n, level = REGION_METHODS[name], 88, 0.9
    shares = []
    for seed in range(300):
        rows = residuals(n + 89 + 200, seed)
        region = method.region(rows[-200:], rows[:n], MARKERS, level)
        shares.append(region.covers(rows[n:-200]).mean())
    rank = conformal_rank(n, level)
    assert rank is not None
    distance = (np.mean(shares) - rank / (n + 1)) / (np.std(shares) / np.sqrt(len(shares)))
    if method.is_exact:
        assert abs(distance) < 4
    else:
        assert distance > -4


@pytest.mark.parametrize("name", REGION_METHODS)
def test_wider_levels_contain_narrower_ones(name: str) -> None:
    rows, region = residuals(400, 0), REGION_METHODS[name].region
    narrow, wide = (region(rows[:100], rows[100:300], MARKERS, level) for level in (0.8, 0.95))
    assert narrow.size_mm < wide.size_mm
    assert not (narrow.covers(rows[300:]) & ~wide.covers(rows[300:])).any()


@pytest.mark.parametrize("name", REGION_METHODS)
def test_too_few_calibration_rows_give_everything(name: str) -> None:
    rows = residuals(50, 0)
    region = REGION_METHODS[name].region(rows, rows[:5], MARKERS, 0.95)
    assert region.size_mm == np.inf
    assert region.covers(1e9 * rows).all()


@pytest.mark.parametrize("name", REGION_METHODS)
def test_units_pass_through(name: str) -> None:
    rows, region = residuals(300, 0), REGION_METHODS[name].region
    one, ten = (region(f * rows[:100], f * rows[100:200], MARKERS, 0.9) for f in (1.0, 10.0))
    assert ten.size_mm == pytest.approx(10 * one.size_mm)
    np.testing.assert_array_equal(one.covers(rows[200:]), ten.covers(10 * rows[200:]))


def test_the_size_is_the_side_of_the_cube_of_equal_volume() -> None:
    """Known residuals of one marker: all of length 3 mm."""
    rng = np.random.default_rng(0)
    rows = rng.standard_normal((5000, 3))
    rows *= 3.0 / np.linalg.norm(rows, axis=1, keepdims=True)
    one = np.zeros(3, dtype=np.intp)
    ball = (4 / 3 * np.pi) ** (1 / 3) * 3.0
    for name in ("joint_balls", "joint_scaled_balls", "joint_ellipsoids"):
        assert REGION_METHODS[name].region(rows, rows, one, 0.9).size_mm == pytest.approx(ball, rel=0.02)
    limit = np.sort(np.abs(rows).max(axis=1) / error_scale(np.abs(rows)).mean())[4501]
    box = REGION_METHODS["joint_box"].region(rows, rows, one, 0.9)
    assert box.size_mm == pytest.approx(2 * error_scale(np.abs(rows)).mean() * limit, rel=0.02)


def test_an_ellipsoid_is_the_smallest_where_errors_are_normal_and_correlated() -> None:
    rng = np.random.default_rng(0)
    rows = rng.standard_normal((4000, 3)) @ np.array([[1.0, 0.95, 0.9], [0, 0.1, 0.1], [0, 0, 0.05]])
    one = np.zeros(3, dtype=np.intp)
    sizes = {name: m.region(rows[:1000], rows[1000:], one, 0.9).size_mm for name, m in REGION_METHODS.items()}
    assert min(sizes, key=lambda name: sizes[name]) == "joint_ellipsoids"
    moments = rows.T @ rows / len(rows)
    volume = 4 / 3 * np.pi * np.sqrt(np.linalg.det(moments)) * chi2.ppf(0.9, 3) ** 1.5
    assert sizes["joint_ellipsoids"] == pytest.approx(volume ** (1 / 3), rel=0.03)


def test_a_scale_that_is_zero_divides_nothing() -> None:
    exact = np.zeros((20, 6))
    for name, method in REGION_METHODS.items():
        region = method.region(exact, residuals(200, 1), MARKERS, 0.9)
        assert 0 < region.size_mm < np.inf, name
        assert region.covers(exact).all(), name


@pytest.mark.parametrize("name", REGION_METHODS)
def test_it_is_registered_under_its_own_name(name: str) -> None:
    assert REGION_METHODS[name].name == name
    assert REGION_METHODS[name].title
