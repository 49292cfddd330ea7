from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.samples import SUBSETS, TRAIN, Samples
from softkin.data.table import read_subset, to_table, write_table


@pytest.fixture
def garbage_table(table: Path, tmp_path: Path) -> Path:
    """The same table with all positions but those of train replaced by garbage."""
    subsets = {subset: read_subset(table, subset) for subset in SUBSETS}
    garbage = {s: Samples(rows.commands, 1e6 - rows.positions) for s, rows in subsets.items() if s != TRAIN}
    write_table(to_table(subsets | garbage), tmp_path / "garbage.parquet")
    return tmp_path / "garbage.parquet"
