from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.errors import DataError
from softkin.data.readers.motive_export import open_table
from tests.conftest import HOUSE


def test_names_unit_and_gaps_of_an_export_are_read() -> None:
    table = open_table(HOUSE / "tests" / "cases" / "06_motive_export.csv", {})
    markers = [f"arm:Marker{marker}_{axis}" for marker in (1, 2) for axis in "xyz"]
    assert table.names == ("Frame", "Time (Seconds)", *markers)
    assert table.units[2:] == ("mm",) * 6
    values, _ = table.read(range(2, 8), [], gaps=True)
    assert values.shape == (120, 6)
    assert values[0].tolist() == [6.431284, 20.461680, 54.319237, 12.862568, 40.923361, 108.638474]


def test_an_export_without_its_header_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "take.csv").write_text("Format Version,1.23\nFrame,Time\n0,0\n")
    with pytest.raises(DataError, match="without its rows of names"):
        open_table(tmp_path / "take.csv", {})
