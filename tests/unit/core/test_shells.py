from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from softkin.core.errors import DataError
from softkin.core.shells import command_norm, outer_shells


@given(st.lists(st.integers(0, 20), min_size=5, max_size=60).filter(lambda norms: len(set(norms)) > 1))
def test_every_row_of_a_shell_lies_farther_out_than_its_core(norms: list[int]) -> None:
    values = np.array(norms, dtype=float)
    shells = outer_shells(values, (0.0, 0.5, 0.8))
    assert shells
    for core, shell in shells:
        assert sorted(np.concatenate([core, shell])) == list(range(len(values)))
        assert values[core].max() < values[shell].min()
    assert [len(core) for core, _ in shells] == sorted({len(core) for core, _ in shells})


def test_a_core_holds_its_share_of_distinct_commands() -> None:
    shells = outer_shells(np.arange(101.0), (0.7, 0.5))
    assert [len(core) for core, _ in shells] == [51, 71]


def test_commands_that_lie_equally_far_out_have_no_shell() -> None:
    with pytest.raises(DataError, match="no outer shell") as error:
        outer_shells(np.ones(9), (0.5, 0.7))
    assert "objective: interpolation" in str(error.value.fix)


def test_the_norm_is_raw_or_standardised_and_a_constant_command_counts_for_nothing() -> None:
    train = np.array([[1.0, 100.0, 7.0], [3.0, 300.0, 7.0]])
    raw, standardised = (command_norm(train, standardised=kind) for kind in (False, True))
    assert raw.of(np.array([[3.0, 4.0, 0.0]])) == pytest.approx([5.0])
    assert standardised.of(train) == pytest.approx([np.sqrt(2)] * 2)
    assert standardised.of(np.array([[2.0, 300.0, 9.0]])) == pytest.approx([1.0])
