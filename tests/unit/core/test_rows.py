from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import softkin.core.rows
from softkin.core.rows import (
    command_scale,
    first_of_each,
    in_parts,
    repeats_an_earlier_row,
    row_groups,
    sampled_rows,
    shares_its_pose,
    split_by_subset,
    stacked_commands,
    stacked_positions,
)
from softkin.core.samples import Array, Samples

SMALL = hnp.arrays(
    np.float64, st.tuples(st.integers(1, 30), st.integers(1, 3)), elements=st.sampled_from([0.0, 1.0, 0.1])
)


@given(SMALL)
def test_groups_are_those_of_a_comparison_of_all_pairs(values: Array) -> None:
    groups = row_groups(values)
    same = (values[:, None] == values[None]).all(axis=2)
    np.testing.assert_array_equal(groups[:, None] == groups[None], same)
    np.testing.assert_array_equal(repeats_an_earlier_row(groups), np.tril(same, -1).any(axis=1))
    np.testing.assert_array_equal(first_of_each(groups), np.flatnonzero(~np.tril(same, -1).any(axis=1)))


def test_zero_equals_minus_zero_and_nothing_else_is_rounded() -> None:
    values = np.array([[0.0], [-0.0], [np.nextafter(0.0, 1.0)], [1.0], [np.nextafter(1.0, 2.0)]])
    assert row_groups(values).tolist() == [0, 0, 1, 2, 3]


def test_groups_do_not_depend_on_the_chunk(monkeypatch: pytest.MonkeyPatch) -> None:
    values = np.random.default_rng(0).integers(0, 3, (100, 2)).astype(float)
    whole = row_groups(values)
    monkeypatch.setattr(softkin.core.rows, "CHUNK", 7)
    np.testing.assert_array_equal(row_groups(values), whole)


def test_a_pose_is_shared_only_across_commands() -> None:
    poses, commands = np.array([0, 0, 1, 1, 2]), np.array([0, 1, 2, 2, 3])
    assert shares_its_pose(poses, commands).tolist() == [True, True, False, False, False]


def test_a_sample_is_bounded_ascending_and_seeded() -> None:
    rows = sampled_rows(1000, 50, seed=1)
    assert len(set(rows.tolist())) == 50
    assert (np.diff(rows) > 0).all()
    np.testing.assert_array_equal(rows, sampled_rows(1000, 50, seed=1))
    assert sampled_rows(50, 50, seed=1).tolist() == list(range(50))


def test_a_command_that_never_varies_keeps_its_unit() -> None:
    assert command_scale(np.array([[0.1, 0.0], [0.1, 2.0], [0.1, 4.0]])).tolist() == pytest.approx(
        [1.0, np.sqrt(8 / 3)]
    )


def test_what_is_stacked_is_split_again() -> None:
    samples = {name: Samples(np.full((n, 2), float(n)), np.full((n, 3), float(n))) for name, n in (("a", 2), ("b", 3))}
    parts = split_by_subset(stacked_positions(samples, np.array([True, False, True])), samples)
    assert {name: part.tolist() for name, part in parts.items()} == {"a": [[2.0, 2.0]] * 2, "b": [[3.0, 3.0]] * 3}
    assert stacked_commands(samples).shape == (5, 2)


def test_parts_hold_all_rows_in_their_order_and_at_most_so_many() -> None:
    values = np.arange(50.0).reshape(25, 2)
    assert [len(part) for part in in_parts(values, 10)] == [9, 8, 8]
    np.testing.assert_array_equal(np.concatenate(in_parts(values, 10)), values)
    assert [len(part) for part in in_parts(values, 25)] == [25]
    assert [len(part) for part in in_parts(values[:0], 10)] == [0]
