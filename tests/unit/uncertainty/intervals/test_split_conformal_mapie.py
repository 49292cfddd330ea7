from __future__ import annotations

import numpy as np
import pytest

from softkin.core.errors import ConfigError
from softkin.uncertainty.intervals.split_conformal_mapie import intervals
from tests.unit.uncertainty.conftest import LEVELS, around_point, point_calibration, split_conformal_by_hand


@pytest.mark.parametrize("n", [88, 89, 99, 140, 395])
def test_intervals_are_those_of_a_few_lines_of_numpy(n: int) -> None:
    data = point_calibration(n)
    np.testing.assert_allclose(intervals(data, LEVELS), split_conformal_by_hand(data), rtol=0, atol=1e-12)


def test_without_a_level_that_the_rows_suffice_for_all_is_infinite() -> None:
    bounds = intervals(point_calibration(3), LEVELS)
    assert (bounds[..., 0] == -np.inf).all()
    assert (bounds[..., 1] == np.inf).all()


def test_a_level_that_mapie_does_not_take_gets_a_sentence() -> None:
    with pytest.raises(ConfigError, match="confidence level 1e-09 is less than MAPIE takes of 99 calibration rows"):
        intervals(point_calibration(99), [1e-9, 0.9])
    assert np.isfinite(intervals(point_calibration(99), [0.011])).all()


def test_one_dimension_where_two_are_meant_is_refused() -> None:
    with pytest.raises(ValueError, match="shape"):
        intervals(around_point(np.zeros(9), np.zeros((9, 1)), np.zeros((2, 1))), LEVELS)
