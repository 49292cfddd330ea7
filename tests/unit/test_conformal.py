from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from softkin.conformal import closed, columns, conformal_rank, engine_level

ALPHAS = ("0.01", "0.05", "0.1", "0.2", "0.3")


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_rank_by_counting_scores(alpha: str) -> None:
    """k is the least rank for which a new score is among the k smallest of n + 1 with probability 1 - alpha."""
    level = float(1 - Fraction(alpha))
    for n in range(1, 2001):
        wanted = (1 - Fraction(alpha)) * (n + 1)
        counted = next(k for k in range(max(1, int(wanted) - 1), n + 2) if k >= wanted)
        assert conformal_rank(n, level) == (counted if counted <= n else None), n


@pytest.mark.parametrize("alpha", ALPHAS)
def test_no_engine_can_round_the_level_it_is_given_wrongly(alpha: str) -> None:
    level = float(1 - Fraction(alpha))
    for n in range(1, 2001):
        rank = conformal_rank(n, level)
        if rank is not None:
            given_level = engine_level(n, rank)
            assert n - int((1 - given_level) * (n + 1)) + 1 == rank  # as crepes counts, from the largest
            assert int(np.ceil(given_level * (n + 1))) == rank  # as MAPIE counts, from the smallest


def test_a_calibration_set_that_is_too_small_has_no_rank() -> None:
    assert conformal_rank(8, 0.9) is None
    assert conformal_rank(9, 0.9) == 9
    assert conformal_rank(18, 0.95) is None


@given(arrays(float, (3, 4, 2), elements=st.floats(-10, 10)))
def test_an_empty_interval_is_closed_to_its_middle_and_no_other_is_touched(intervals: np.ndarray) -> None:
    result = closed(intervals)
    empty = intervals[..., 0] > intervals[..., 1]
    np.testing.assert_array_equal(result[~empty], intervals[~empty])
    np.testing.assert_array_equal(result[empty][:, 0], result[empty][:, 1])
    assert (result[..., 0] <= result[..., 1]).all()


def test_engines_get_one_coordinate_at_a_time() -> None:
    assert [c.tolist() for c in columns(np.arange(4).reshape(2, 2))] == [[0, 2], [1, 3]]
    with pytest.raises(ValueError, match="shape"):
        columns(np.zeros(3))
