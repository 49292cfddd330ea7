from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from softkin.core.errors import DataError
from softkin.core.folds import folds_of, grouped_folds
from softkin.core.samples import Samples
from tests.recorded_robot import recorded_arm


@given(
    st.lists(st.integers(0, 9), min_size=30, max_size=60).filter(lambda groups: len(set(groups)) >= 4),
    st.integers(2, 4),
    st.integers(0, 99),
)
def test_a_distinct_command_stands_on_one_side_of_a_fold(groups: list[int], n_folds: int, seed: int) -> None:
    commands = np.array(groups, dtype=float)[:, None] * [1.0, -2.0]
    folds = grouped_folds(commands, n_folds, seed)
    assert sorted(np.concatenate([held_out for _, held_out in folds])) == list(range(len(commands)))
    for fitted, held_out in folds:
        assert not set(map(tuple, commands[fitted])) & set(map(tuple, commands[held_out]))


def test_too_few_distinct_commands_is_an_error() -> None:
    with pytest.raises(DataError, match="2 distinct commands are too few for 5 folds") as error:
        grouped_folds(np.array([[0.0], [1.0]] * 20), 5, 0)
    assert error.value.where == "`train`"
    assert "tuning.n_folds and refitting.n_folds" in str(error.value.fix)


def test_folds_of_a_recording_are_stretches_of_time() -> None:
    rows = recorded_arm(400).take(np.random.default_rng(0).permutation(400))
    assert rows.recording is not None
    for fitted, held_out in folds_of(rows, 4, seed=0):
        assert sorted([*fitted, *held_out]) == list(range(400))
        assert abs(len(held_out) - 100) <= 10
        in_time = np.sort(rows.recording.order[held_out])
        assert (np.diff(in_time) > 1).sum() < 10  # at most ten stretches


def test_folds_of_other_rows_are_by_distinct_command(samples: Samples) -> None:
    ours, plain = folds_of(samples, 3, seed=1), grouped_folds(samples.commands, 3, seed=1)
    for one, other in zip(ours, plain, strict=True):
        np.testing.assert_array_equal(one[1], other[1])
