from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from softkin.core.errors import DataError
from softkin.core.folds import grouped_folds


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
