from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from softkin.conformal import columns, conformal_rank, engine_level, nested

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


@given(arrays(float, (3, 4, 2, 2), elements=st.floats(-10, 10)))
def test_nested_levels_contain_each_other_and_only_widen(intervals: np.ndarray) -> None:
    result = nested(intervals)
    assert (result[..., 0] <= intervals[..., 0]).all()
    assert (result[..., 1] >= intervals[..., 1]).all()
    assert (np.diff(result[..., 0], axis=0) <= 0).all()
    assert (np.diff(result[..., 1], axis=0) >= 0).all()


def test_engines_get_one_coordinate_at_a_time() -> None:
    assert [c.tolist() for c in columns(np.arange(4).reshape(2, 2))] == [[0, 2], [1, 3]]
    with pytest.raises(ValueError, match="shape"):
        columns(np.zeros(3))
