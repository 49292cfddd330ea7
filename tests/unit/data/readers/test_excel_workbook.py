from __future__ import annotations

import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import pytest

from softkin.core.errors import DataError
from softkin.data.readers.table_formats import open_table

_SPACE = "http://schemas.openxmlformats.org"
_MAIN = f"{_SPACE}/spreadsheetml/2006/main"
_TYPES = "application/vnd.openxmlformats-officedocument.spreadsheetml"


def write_workbook(path: Path, sheets: Mapping[str, Sequence[Sequence[Any]]]) -> Path:
    """A workbook of these sheets, written by hand: a library for it would serve the tests alone."""
    numbers = range(1, len(sheets) + 1)
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{_SPACE}/package/2006/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{_TYPES}.sheet.main+xml"/>'
        + "".join(f'<Override PartName="/xl/s{n}.xml" ContentType="{_TYPES}.worksheet+xml"/>' for n in numbers)
        + "</Types>",
        "_rels/.rels": f'<Relationships xmlns="{_SPACE}/package/2006/relationships"><Relationship Id="r1" '
        f'Type="{_SPACE}/officeDocument/2006/relationships/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{_MAIN}" xmlns:r="{_SPACE}/officeDocument/2006/relationships"><sheets>'
        + "".join(f'<sheet name="{name}" sheetId="{n}" r:id="r{n}"/>' for n, name in zip(numbers, sheets, strict=True))
        + "</sheets></workbook>",
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{_SPACE}/package/2006/relationships">'
        + "".join(
            f'<Relationship Id="r{n}" Type="{_SPACE}/officeDocument/2006/relationships/worksheet" Target="s{n}.xml"/>'
            for n in numbers
        )
        + "</Relationships>",
    }
    for n, rows in zip(numbers, sheets.values(), strict=True):
        cells = "".join(f'<row r="{r}">{"".join(map(_cell, row))}</row>' for r, row in enumerate(rows, 1))
        parts[f"xl/s{n}.xml"] = f'<worksheet xmlns="{_MAIN}"><sheetData>{cells}</sheetData></worksheet>'
    with zipfile.ZipFile(path, "w") as file:
        for name, text in parts.items():
            file.writestr(name, text)
    return path


def _cell(value: Any) -> str:
    if value is None:
        return "<c/>"
    if isinstance(value, str):
        return f'<c t="inlineStr"><is><t>{escape(value)}</t></is></c>'
    return f"<c><v>{value!r}</v></c>"


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
