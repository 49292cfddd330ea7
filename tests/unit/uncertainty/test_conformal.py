from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.stats import kstest

from softkin.uncertainty.conformal import (
    closed,
    columns,
    conformal_limit,
    conformal_rank,
    engine_level,
    p_values,
    two_sided_rank,
)

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


@given(
    st.integers(1, 40),
    st.integers(0, 10_000),
    st.sampled_from([0.8, 0.9, 0.95]),
)
def test_the_p_value_is_the_papers_and_says_what_the_interval_says(n: int, seed: int, level: float) -> None:
    rng = np.random.default_rng(seed)
    known, new = rng.integers(0, 6, (n, 2)).astype(float), rng.integers(0, 8, (15, 2)).astype(float)
    found = p_values(known, new)
    for row, scores in enumerate(new):
        for column, score in enumerate(scores):
            assert found[row, column] == ((known[:, column] >= score).sum() + 1) / (n + 1)
    alpha = Fraction(1) - Fraction(str(level))
    limit = conformal_limit(known[:, 0], level)
    inside = [Fraction(round(p * (n + 1)), n + 1) > alpha for p in found[:, 0]]
    np.testing.assert_array_equal(new[:, 0] <= limit, inside)


def test_smoothed_p_values_are_uniform_even_with_ties_and_use_their_own_generator() -> None:
    rng = np.random.default_rng(0)
    state = np.random.get_state()[1].copy()
    found = np.concatenate(
        [p_values(*np.split(rng.integers(0, 3, (40, 1)).astype(float), 2), rng=rng) for _ in range(500)]
    )
    np.testing.assert_array_equal(np.random.get_state()[1], state)
    assert kstest(found.ravel()[::20], "uniform").pvalue > 0.01
    assert found.mean() == pytest.approx(0.5, abs=4 * found.std() / np.sqrt(500))


@pytest.mark.parametrize("level", [0.8, 0.9, 0.95])
def test_a_two_sided_interval_leaves_the_same_number_of_places_out_on_either_side(level: float) -> None:
    for n in range(1, 500):
        rank, side = two_sided_rank(n, level), conformal_rank(n, round((1 + level) / 2, 12))
        assert (rank is None) == (side is None)
        if rank is not None and side is not None:
            assert rank == side - (n + 1 - side)
            assert level <= rank / (n + 1) <= level + 2 / (n + 1)
