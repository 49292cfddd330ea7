"""crepes and a few lines of numpy give the same intervals.

crepes 0.9.1, called plainly, takes a rank one too large at 0.9 for n = 9 mod 10 (floating point); the method does not.
"""

from __future__ import annotations

import numpy as np
import pytest
from crepes import ConformalRegressor

from softkin.uncertainty.intervals.split_conformal_crepes import intervals
from tests.unit.uncertainty.conftest import LEVELS, around_point, point_calibration, rank, split_conformal_by_hand


@pytest.mark.parametrize("n", [88, 89, 99, 140, 395])
def test_intervals_are_those_of_a_few_lines_of_numpy(n: int) -> None:
    data = point_calibration(n)
    np.testing.assert_allclose(intervals(data, LEVELS), split_conformal_by_hand(data), rtol=0, atol=1e-12)


def test_crepes_alone_would_take_another_rank() -> None:
    """The defect the method works around; when crepes fixes it, this test says so."""
    scores = np.arange(1.0, 10.0)
    with pytest.warns(UserWarning, match="too small"):
        plain = ConformalRegressor().fit(scores).predict_int(np.zeros(1), confidence=0.9)[0, 1]
    ours = intervals(around_point(np.zeros((9, 1)), scores[:, None], np.zeros((1, 1))), [0.9])[0, 0, 0, 1]
    assert ours == scores[rank(9, 0.9) - 1] == 9.0
    assert plain == np.inf


def test_one_dimension_where_two_are_meant_is_refused() -> None:
    with pytest.raises(ValueError, match="shape"):
        intervals(around_point(np.zeros(9), np.zeros((9, 1)), np.zeros((2, 1))), LEVELS)
