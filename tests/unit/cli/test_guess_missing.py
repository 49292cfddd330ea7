from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from softkin.cli.guess_entry import guess_entry
from softkin.data.readers import table_file
from tests.unit.cli.tables import columns


@pytest.mark.parametrize("word", [0.0, -1.0, -9999.0, np.nan])
def test_markers_that_were_lost_are_left_out_and_said(tmp_path: Path, word: float) -> None:
    table = columns("u1", "u2", "x", "y", "z")[:120].copy()
    table[["x", "y", "z"]] += 60.0
    table.loc[::20, ["x", "y", "z"]] = word
    table.to_csv(tmp_path / "arm.csv", index=False)
    entry, reasons = guess_entry(tmp_path / "arm.csv", "Arm", "arm.csv")
    assert entry["missing"] == "drop_rows"
    assert any("6 of 120 rows lack a number" in reason for reason in reasons)
    rows = table_file.read(tmp_path / "arm.csv", dataset="arm", source=entry)
    assert sum(map(len, rows.values())) == 114
    assert min(part.positions.min() for part in rows.values()) > 0
