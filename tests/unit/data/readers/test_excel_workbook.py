from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from softkin.core.errors import DataError
from softkin.data.readers.table_formats import open_table
from tests.workbooks import write_workbook

TABLE: list[list[Any]] = [
    ["Recorded in May", None, None, None],
    [None, None, None, None],
    ["u1", "u2", "x", "trial"],
    ["bar", "bar", "mm", None],
    [0.1, 2, 3.3000000000000003, "a"],
    [1 / 3, 4.0, 5.25, "b"],
]


def test_a_sheet_is_read_to_the_bit_below_its_preamble_and_units(tmp_path: Path) -> None:
    path = write_workbook(tmp_path / "arm.xlsx", {"Data": TABLE, "Empty": []})
    table = open_table(path, {})
    assert table.names == ("u1", "u2", "x", "trial")
    assert table.units == ("bar", "bar", "mm", "")
    values, (trial,) = table.read([0, 1, 2], [3])
    assert values.tolist() == [[0.1, 2.0, 3.3000000000000003], [1 / 3, 4.0, 5.25]]
    assert trial.tolist() == ["a", "b"]
    assert table.place(1) == "line 6"


def test_one_of_several_sheets_is_named_and_not_chosen(tmp_path: Path) -> None:
    path = write_workbook(tmp_path / "arm.xlsx", {"first": TABLE, "second": [["u1", "x"], [1.0, 2.0], [3.0, 4.0]]})
    with pytest.raises(DataError, match="2 sheets hold rows: first, second") as raised:
        open_table(path, {})
    assert "SHEET=" in str(raised.value)
    assert open_table(path, {"sheet": "second"}).names == ("u1", "x")
    with pytest.raises(DataError, match="no sheet 'third'"):
        open_table(path, {"sheet": "third"})


def test_a_bad_cell_and_a_gap_are_named_with_their_row(tmp_path: Path) -> None:
    rows: list[list[Any]] = [["u1", "x"], [1.0, 2.0], ["soon", 4.0], [5.0, None]]
    table = open_table(write_workbook(tmp_path / "arm.xlsx", {"s": rows}), {})
    with pytest.raises(DataError, match="line 3, column 'u1': no number: 'soon'"):
        table.read([0], [])
    with pytest.raises(DataError, match="line 4, column 'x': no value"):
        table.read([1], [])
    assert table.read([1], [], gaps=True)[0][:2].tolist() == [[2.0], [4.0]]


@pytest.mark.parametrize("content", [b"\xd0\xcf\x11\xe0 old", b"PK\x03\x04" + b"\0" * 26 + b"[Content_Types].xml"])
def test_a_damaged_workbook_is_an_error(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "arm.xls").write_bytes(content)
    with pytest.raises(DataError, match="not readable as a workbook"):
        open_table(tmp_path / "arm.xls", {})
