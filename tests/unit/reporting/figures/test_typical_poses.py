"""Which poses are typical."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.reporting.figures.typical_poses import NEAR, QUANTILES, ranks, relative_errors, typical_poses


def test_a_relative_error_above_one_is_a_miss_in_the_worst_coordinate() -> None:
    rng = np.random.default_rng(0)
    true, lower = rng.normal(size=(2, 200, 3))
    upper = lower + rng.uniform(0.5, 3.0, lower.shape)
    is_missed = ((true < lower) | (upper < true)).any(axis=1)
    np.testing.assert_array_equal(relative_errors(true, lower, upper) > 1, is_missed)
    ones = np.ones((1, 1))
    assert relative_errors(3 * ones, -ones, ones) == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("true", "lower", "upper", "expected"),
    [(5.0, -np.inf, np.inf, 0.0), (5.0, 6.0, np.inf, np.inf), (5.0, 5.0, 5.0, 0.0), (5.0, 4.0, 4.0, np.inf)],
)
def test_intervals_without_a_middle_or_a_width_cover_or_miss(
    true: float, lower: float, upper: float, expected: float
) -> None:
    cells = (np.array([[value]]) for value in (true, lower, upper))
    assert relative_errors(*cells) == expected


def test_ranks_are_shares_of_the_other_rows() -> None:
    np.testing.assert_array_equal(ranks(np.array([3.0, 1.0, 2.0])), [1.0, 0.0, 0.5])
    assert ranks(np.array([7.0])) == 0.0


def test_poses_are_near_the_middle_of_each_quarter_and_far_apart() -> None:
    rng = np.random.default_rng(0)
    rank, positions = rng.permutation(101) / 100, rng.normal(size=(101, 3))
    numbers = typical_poses(rank / 2, positions)  # none is missed
    assert sorted(numbers[numbers > 0]) == [1, 2, 3, 4]
    rows = [np.flatnonzero(numbers == number).item() for number in (1, 2, 3, 4)]
    for n, (row, level) in enumerate(zip(rows, QUANTILES, strict=True)):
        near = np.abs(rank - level) <= NEAR
        assert near[row]
        others = positions[rows[:n]] if n else positions.mean(axis=0, keepdims=True)
        apart = np.linalg.norm(positions[:, None] - others[None], axis=-1).min(axis=1)
        assert apart[row] == apart[near].max()


@pytest.mark.parametrize("share", [0.0, 0.2, 0.36, 0.5, 0.65, 0.81, 0.9, 1.0])
def test_as_many_poses_are_covered_as_a_rounded_share_of_all_rows(share: float) -> None:
    rng = np.random.default_rng(1)
    scores = np.r_[rng.uniform(0, 1, round(100 * share)), rng.uniform(1.1, 9, 100 - round(100 * share))]
    numbers = typical_poses(scores, rng.normal(size=(100, 3)))
    n_covered = int((scores[numbers > 0] <= 1).sum())
    assert abs(n_covered - 4 * share) <= 0.6


def test_a_row_of_gross_error_is_no_typical_pose() -> None:
    positions = np.zeros((100, 3))
    positions[99] = 500.0  # the row of largest error lies far off, too
    assert typical_poses(np.arange(100.0), positions)[99] == 0


@pytest.mark.parametrize(("n_rows", "n_poses"), [(1, 1), (2, 2), (3, 3), (40, 4)])
def test_few_rows_have_fewer_poses_and_none_twice(n_rows: int, n_poses: int) -> None:
    numbers = typical_poses(np.arange(n_rows) / 100, np.random.default_rng(1).normal(size=(n_rows, 3)))
    assert numbers[numbers > 0].tolist() == list(range(1, n_poses + 1))  # the scores ascend
