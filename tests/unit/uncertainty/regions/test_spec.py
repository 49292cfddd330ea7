"""Every joint region of the registry: what it covers, and that the law of its coverage is exact where it says so."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.conformal import conformal_rank
from softkin.uncertainty.regions import REGION_METHODS
from tests.unit.uncertainty.regions.conftest import MARKERS, residuals


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
def test_higher_levels_contain_lower_ones(name: str) -> None:
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


@pytest.mark.parametrize("name", REGION_METHODS)
def test_a_scale_that_is_zero_divides_nothing(name: str) -> None:
    exact = np.zeros((20, 6))
    region = REGION_METHODS[name].region(exact, residuals(200, 1), MARKERS, 0.9)
    assert 0 < region.size_mm < np.inf
    assert region.covers(exact).all()


@pytest.mark.parametrize("name", REGION_METHODS)
def test_it_is_registered_under_its_own_name(name: str) -> None:
    assert REGION_METHODS[name].name == name
    assert REGION_METHODS[name].title
