from __future__ import annotations

import numpy as np
import pytest

from softkin.data.blocks import blocks

COMMANDS = np.arange(12.0)[:, None]


def test_groups_and_stretches_are_blocks() -> None:
    trial = np.repeat([3, 1, 2], 4)
    assert blocks({"method": "group", "column": "trial"}, COMMANDS, trial, str) is not None
    found = blocks({"method": "group", "column": "trial"}, COMMANDS, trial, str)
    assert found is not None
    assert len(set(zip(found.tolist(), trial.tolist(), strict=True))) == 3
    stretches = blocks({"method": "time", "column": "t", "blocks": 3}, COMMANDS, COMMANDS[:, 0], str)
    assert stretches is not None
    assert np.bincount(stretches).tolist() == [4, 4, 4]


def test_rows_of_one_command_are_a_block_where_commands_repeat() -> None:
    assert blocks({"method": "random"}, COMMANDS, None, str) is None
    repeated = blocks({"method": "random"}, COMMANDS // 2, None, str)
    assert repeated is not None
    assert np.bincount(repeated).tolist() == [2] * 6


@pytest.mark.parametrize("method", ["session", "later"])
def test_the_future_is_one_block(method: str) -> None:
    found = blocks({"method": method}, COMMANDS, None, str)
    assert found is not None
    assert set(found.tolist()) == {0}


def test_of_subsets_that_the_file_names_nothing_is_known() -> None:
    assert blocks({"method": "column", "column": "part"}, COMMANDS, None, str) is None
