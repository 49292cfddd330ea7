from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.stats import kstest

from softkin.core.samples import Array
from softkin.uncertainty.conformal import (
    around,
    closed,
    columns,
    conformal_limit,
    conformal_limits,
    conformal_rank,
    engine_level,
    error_scale,
    global_random_state_kept,
    joint_scores,
    normalised_intervals,
    p_values,
    two_sided_rank,
    unbounded,
    uncrossed,
    weighted_limits,
)
from tests.unit.uncertainty.conftest import LEVELS, global_random_state, point_calibration, rank

ALPHAS = ("0.01", "0.05", "0.1", "0.2", "0.3")


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_rank_by_counting_scores(alpha: str) -> None:
    """k is the least rank for which a new score is among the k smallest of n + 1 with probability 1 - alpha."""
    level = float(1 - Fraction(alpha))
    for n in range(1, 2001):
        wanted = (1 - Fraction(alpha)) * (n + 1)
        counted = next(k for k in range(max(1, int(wanted) - 1), n + 2) if k >= wanted)
        assert conformal_rank(n, level) == (counted if counted <= n else None), n


def test_the_limit_is_the_score_of_that_rank_and_infinite_where_there_is_none() -> None:
    scores = np.array([3.0, 1.0, 2.0, 4.0])
    assert [conformal_limit(scores, level) for level in (0.2, 0.5, 0.8, 0.81)] == [1.0, 3.0, 4.0, np.inf]
    columns_of = np.column_stack([scores, 10 * scores])
    assert conformal_limits(columns_of, [0.5, 0.9]).tolist() == [[3.0, 30.0], [np.inf, np.inf]]


@pytest.mark.parametrize("alpha", ALPHAS)
def test_no_engine_can_round_the_level_it_is_given_wrongly(alpha: str) -> None:
    level = float(1 - Fraction(alpha))
    for n in range(1, 2001):
        rank = conformal_rank(n, level)
        if rank is not None:
            exact = engine_level(n, rank)
            assert n - int((1 - exact) * (n + 1)) + 1 == rank  # as crepes counts, from the largest
            assert int(np.ceil(exact * (n + 1))) == rank  # as MAPIE counts, from the smallest


def test_a_calibration_set_that_is_too_small_has_no_rank() -> None:
    assert conformal_rank(8, 0.9) is None
    assert conformal_rank(9, 0.9) == 9
    assert conformal_rank(18, 0.95) is None


@settings(deadline=None)
@given(arrays(float, (3, 4, 2), elements=st.floats(-10, 10)))
def test_an_empty_interval_is_closed_to_its_middle_and_no_other_is_touched(intervals: Array) -> None:
    result = closed(intervals)
    empty = intervals[..., 0] > intervals[..., 1]
    np.testing.assert_array_equal(result[~empty], intervals[~empty])
    np.testing.assert_array_equal(result[empty][:, 0], result[empty][:, 1])
    assert (result[..., 0] <= result[..., 1]).all()


def test_engines_get_one_coordinate_at_a_time() -> None:
    assert [c.tolist() for c in columns(np.arange(4.0).reshape(2, 2))] == [[0, 2], [1, 3]]
    with pytest.raises(ValueError, match="shape"):
        columns(np.zeros(3))


@settings(deadline=None)
@given(
    st.integers(1, 40),
    st.integers(0, 10_000),
    st.sampled_from([0.8, 0.9, 0.95]),
)
def test_the_p_value_is_the_papers_and_says_what_the_interval_says(n: int, seed: int, level: float) -> None:
    rng = np.random.default_rng(seed)
    known, new = rng.integers(0, 6, (n, 2)).astype(float), rng.integers(0, 8, (15, 2)).astype(float)
    values = p_values(known, new)
    for row, scores in enumerate(new):
        for column, score in enumerate(scores):
            assert values[row, column] == ((known[:, column] >= score).sum() + 1) / (n + 1)
    alpha = Fraction(1) - Fraction(str(level))
    limit = conformal_limit(known[:, 0], level)
    agrees = [Fraction(round(p * (n + 1)), n + 1) > alpha for p in values[:, 0]]
    np.testing.assert_array_equal(new[:, 0] <= limit, agrees)


def test_smoothed_p_values_are_uniform_even_with_ties_and_use_their_own_generator() -> None:
    rng = np.random.default_rng(0)
    state = global_random_state()
    values = np.concatenate(
        [p_values(*np.split(rng.integers(0, 3, (40, 1)).astype(float), 2), rng=rng) for _ in range(500)]
    )
    np.testing.assert_array_equal(global_random_state(), state)
    assert kstest(values.ravel()[::20], "uniform").pvalue > 0.01
    assert values.mean() == pytest.approx(0.5, abs=4 * values.std() / np.sqrt(500))


@pytest.mark.parametrize("level", [0.8, 0.9, 0.95])
def test_a_two_sided_interval_leaves_the_same_number_of_places_out_on_either_side(level: float) -> None:
    for n in range(1, 500):
        rank, side = two_sided_rank(n, level), conformal_rank(n, round((1 + level) / 2, 12))
        assert (rank is None) == (side is None)
        if rank is not None and side is not None:
            assert rank == side - (n + 1 - side)
            assert level <= rank / (n + 1) <= level + 2 / (n + 1)


def test_equal_weights_are_split_conformal_and_a_heavy_new_row_has_an_infinite_interval() -> None:
    scores = np.abs(np.random.default_rng(0).standard_normal((140, 3)))
    plain = weighted_limits(scores, np.full(140, 2.5), np.full(4, 2.5), LEVELS)
    for level, limits in zip(LEVELS, plain, strict=True):
        expected = np.sort(scores, axis=0)[rank(140, level) - 1]
        np.testing.assert_array_equal(limits, np.broadcast_to(expected, (4, 3)))
    halves = weighted_limits(np.array([[3.0], [1.0], [2.0]]), np.array([1.0, 2.0, 3.0]), np.array([0.0, 4.0]), [0.5])
    np.testing.assert_array_equal(halves[0, :, 0], [2.0, 2.0])
    assert np.isinf(weighted_limits(scores, np.ones(140), np.array([36.0]), [0.8])).all()


def test_intervals_around_a_prediction_are_symmetric() -> None:
    bounds = around(np.array([[1.0, 2.0]]), np.array([[[0.5, 1.0]], [[1.0, 2.0]]]))
    assert bounds.tolist() == [[[[0.5, 1.5], [1.0, 3.0]]], [[[0.0, 2.0], [0.0, 4.0]]]]


def test_what_is_not_filled_in_is_unbounded() -> None:
    bounds = unbounded(2, (3, 4))
    assert bounds.shape == (2, 3, 4, 2)
    assert set(bounds[..., 0].ravel()) == {-np.inf}
    assert set(bounds[..., 1].ravel()) == {np.inf}


def test_crossed_quantiles_are_exchanged_and_others_kept() -> None:
    assert uncrossed(np.array([[1.0, 2.0], [2.0, 1.0]])).tolist() == [[1.0, 2.0], [1.0, 2.0]]


def test_the_scale_of_errors_is_not_moved_by_gross_ones_and_never_zero() -> None:
    errors = np.abs(np.random.default_rng(0).standard_normal((1000, 2))) * [1.0, 10.0]
    scale = error_scale(errors)
    errors[:5] = 1e9
    np.testing.assert_allclose(error_scale(errors), scale, rtol=0.05)
    assert error_scale(errors * [0.0, 1.0])[0] == 1e-6 * error_scale(errors)[1]
    assert error_scale(np.zeros((5, 3))).tolist() == [1.0, 1.0, 1.0]


def test_a_pose_is_as_nonconforming_as_its_worst_coordinate() -> None:
    assert joint_scores(np.array([[1.0, -6.0], [-2.0, 3.0]]), np.array([1.0, 3.0])).tolist() == [2.0, 2.0]


def test_equal_difficulties_are_split_conformal_and_a_difficulty_of_zero_divides_nothing() -> None:
    data = point_calibration(88)
    ones, of_new = np.ones(data.truth.shape), np.ones(data.new.shape)
    plain = normalised_intervals(data, LEVELS, ones, of_new)
    limits = conformal_limits(np.abs(data.truth - data.calibration), LEVELS)[:, None]
    np.testing.assert_allclose(plain, around(data.new, np.broadcast_to(limits, (3, *data.new.shape))), atol=1e-10)
    np.testing.assert_allclose(normalised_intervals(data, LEVELS, 3 * ones, 3 * of_new), plain, atol=1e-10)
    assert np.isfinite(normalised_intervals(data, LEVELS, 0 * ones, 0 * of_new)).all()


def test_the_global_random_state_is_kept_even_where_the_block_fails() -> None:
    before = global_random_state()

    def failing() -> None:
        with global_random_state_kept():
            np.random.seed(7)
            raise RuntimeError

    with pytest.raises(RuntimeError):
        failing()
    np.testing.assert_array_equal(global_random_state(), before)
