from __future__ import annotations

import contextlib
import logging
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from softkin.core.errors import DataError
from softkin.data.readers.delimited_text import DelimitedText, open_text
from softkin.data.readers.text_layout import DELIMITERS, rows_of

NAMES = ("u1", "u2", "tip_x", "tip_y", "note")
ROWS = [["0.5", "-1", "12.25", "1e-3", "a"], ["1.5", "2", "-0.125", "7", "b"], ["+3.5", ".5", "1.", "8E2", "c"]]
VALUES = [[0.5, -1.0, 12.25, 1e-3], [1.5, 2.0, -0.125, 7.0], [3.5, 0.5, 1.0, 800.0]]


def text(delimiter: str = ",", mark: str = ".", rows: list[list[str]] = ROWS, end: str = "\n") -> str:
    lines = [NAMES, *([cell.replace(".", mark) for cell in row] for row in rows)]
    return "".join(delimiter.join(line) + end for line in lines)


def write(folder: Path, content: str | bytes) -> Path:
    path = folder / "robot.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def read(path: Path, delimiter: str | None = None) -> Any:
    table = open_text(path, delimiter)
    assert table.names == NAMES
    values, (notes,) = table.read([0, 1, 2, 3], [4])
    assert notes.tolist() == ["a", "b", "c"]
    return values


@pytest.mark.parametrize("delimiter", DELIMITERS)
@pytest.mark.parametrize("mark", [".", ","])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_delimiter_and_decimal_mark_are_detected_and_logged(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, delimiter: str, mark: str, end: str
) -> None:
    if delimiter == mark:
        pytest.skip("one sign cannot be both")
    with caplog.at_level(logging.INFO, "softkin"):
        np.testing.assert_array_equal(read(write(tmp_path, text(delimiter, mark, end=end))), VALUES)
    assert f"columns split by {DELIMITERS[delimiter]}, decimal {'points' if mark == '.' else 'commas'}" in caplog.text
    assert not [record for record in caplog.records if record.levelno > logging.INFO]


@pytest.mark.parametrize(
    "content",
    [
        text().encode("utf-8-sig"),
        text().encode("utf-16"),
        ("\ufeff" + text()).encode("utf-16-be"),
        b"sep=;\r\n" + text(";", ",", end="\r\n").encode(),
        b"\n\r\n" + text().encode(),
        text().rstrip("\n").encode(),
        text().replace("\n1.5", "\n\n\n1.5").encode(),
        text().replace(",", " , ").encode().replace(b" , a", b",a").replace(b" , b", b",b").replace(b" , c", b",c"),
        text().replace("tip_x", '"tip_x"').replace("0.5", '"0.5"').encode(),
    ],
    ids=["BOM", "UTF-16", "UTF-16-BE", "Excel sep=", "blank above", "no end", "blank within", "spaces", "quotes"],
)
def test_what_programs_write_is_simply_read(tmp_path: Path, content: bytes) -> None:
    np.testing.assert_array_equal(read(write(tmp_path, content)), VALUES)


def test_the_delimiter_can_be_named(tmp_path: Path) -> None:
    np.testing.assert_array_equal(read(write(tmp_path, text(" ")), " "), VALUES)


def test_a_named_delimiter_that_splits_nothing_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"one column only, 'u1,u2,.* split by none of ';'"):
        open_text(write(tmp_path, text()), ";")


def test_a_header_may_have_line_breaks_within_quotes(tmp_path: Path) -> None:
    path = write(tmp_path, '"u\n[bar]",x\n1,2\n3,bad\n')
    table = open_text(path)
    assert table.names == ("u\n[bar]", "x")
    assert table.read([0], [1])[0].tolist() == [[1.0], [3.0]]
    assert table.place(1) == "line 4"
    with pytest.raises(DataError, match="line 4, column 'x': no number: 'bad'"):
        table.read([0, 1], [])


def with_cell(cell: str, **written: Any) -> str:
    return text(rows=[ROWS[0], [ROWS[1][0], cell, *ROWS[1][2:]], ROWS[2]], **written)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", ["the file is empty", "export it again"]),
        (" \n\n", ["the file is empty"]),
        ("u1\n1\n2\n", ["line 1", "one column only", "comma, semicolon, tab, bar, blanks", "`delimiter`"]),
        ("0.5,-1,12.25\n1.5,2,3\n", ["line 1", "no header", "write a row with the names"]),
        ("0,5;-1;12,25\n1,5;2;3\n", ["line 1", "no header"]),
        (with_cell("abc"), ["line 3, column 'u2': no number: 'abc'", "correct the cell"]),
        (with_cell(""), ["line 3, column 'u2': no value", "fill the cell or delete the row"]),
        (with_cell("nan"), ["line 3, column 'u2': no finite number: 'nan'", "delete the row"]),
        (with_cell("-inf"), ["line 3, column 'u2': no finite number: '-inf'"]),
        (with_cell("NA"), ["line 3, column 'u2': no finite number: 'NA'"]),
        (with_cell("1e999"), ["line 3, column 'u2': too large a number: '1e999'"]),
        (with_cell("0x1F"), ["line 3, column 'u2': no number: '0x1F'"]),
        (with_cell("12.5 mm"), ["line 3, column 'u2': no number: '12.5 mm'"]),
        (with_cell("1;5", delimiter=";"), ["line 3: 6 values, but the header names 5"]),
        (with_cell("2", delimiter=";", mark=",").replace("8E2", "8.5"), ["line 4", "'tip_y'", "'8.5'", "one decimal"]),
        (with_cell("2,5", delimiter=";"), ["line 3, column 'u2': '2,5', where other numbers have decimal points"]),
        (with_cell("1,234.5", delimiter=";"), ["line 3, column 'u2': a separator of thousands: '1,234.5'"]),
        (with_cell("1,5"), ["line 3: 6 values", "decimal commas", "semicolons"]),
        (text() + "1,2,3\n", ["line 5: 3 values, but the header names 5 columns"]),
        (text() + ",,,,\n,,,,\n", ["column 'u1': no value (rows with such problems: 2, lines 5, 6)", "drop_rows"]),
        (text() + '"1,2,3,4,d\n', ["line 5: 1 value, but"]),
        ("u1\xa0[\xb0],x\n1,2\n".encode("latin-1"), ["line 1: not utf-8", "0xa0", "CSV UTF-8"]),
        (text().encode("utf-16-le"), ["line 1: zero bytes", "UTF-16", "CSV UTF-8"]),
        (b"a," * 200_000, ["no rows in the first 256 kB"]),
    ],
)  # fmt: skip
def test_a_bad_file_is_named_with_line_column_and_fix(tmp_path: Path, content: str | bytes, says: list[str]) -> None:
    with pytest.raises(DataError) as error:
        open_text(write(tmp_path, content)).read([0, 1, 2, 3], [])
    for part in ("\n  fix: ", *says):
        assert part in str(error.value)


def test_decimal_commas_without_quotes_and_semicolons_are_an_error(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"line 2: 4 values.*\n.*separate columns by semicolons"):
        open_text(write(tmp_path, "u1,x\n0,5,1,5\n0,6,1,7\n")).read([0, 1], [])


def test_numbers_that_may_be_thousands_are_warned_of(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    values, _ = open_text(write(tmp_path, "u1;x\n1,234;2\n5,678;3\n")).read([0, 1], [])
    assert values.tolist() == [[1.234, 2.0], [5.678, 3.0]]
    assert "read as decimal commas" in caplog.text
    assert "robot.csv" in caplog.text


def test_an_undecodable_byte_far_down_is_an_error(tmp_path: Path) -> None:
    rows = "".join(f"{row},2\n" for row in range(60_000))
    with pytest.raises(DataError, match="\n  fix: "):
        open_text(write(tmp_path, b"u1,x\n" + rows.encode() + b"\xff,2\n")).read([0, 1], [])


FINITE = st.floats(allow_nan=False, allow_infinity=False)


@given(
    values=arrays(float, st.tuples(st.integers(1, 6), st.just(3)), elements=FINITE),
    delimiter=st.sampled_from([*DELIMITERS]),
    mark=st.sampled_from([".", ","]),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16"]),
    end=st.sampled_from(["\n", "\r\n"]),
)  # fmt: skip
def test_every_float_survives_to_the_bit(
    tmp_path_factory: pytest.TempPathFactory, values: Any, delimiter: str, mark: str, encoding: str, end: str
) -> None:
    quote = '"' if delimiter == mark else ""
    lines = [delimiter.join(["u", "x", "y"])]
    lines += [delimiter.join(f"{quote}{value!r}{quote}".replace(".", mark) for value in row) for row in values.tolist()]
    path = tmp_path_factory.mktemp("csv") / "robot.csv"
    path.write_bytes((end.join(lines) + end).encode(encoding))
    back, _ = open_text(path).read([0, 1, 2], [])
    assert back.tobytes() == np.ascontiguousarray(values).tobytes()


LETTERS = st.sampled_from([*"0123456789.,;\t|\n\r\"'+-eExyu \0ßnaif#", "\ufeff"])


@given(st.one_of(st.binary(max_size=60), st.text(LETTERS, max_size=80).map(lambda t: ("u,x\n1,2\n" + t).encode())))
def test_any_bytes_are_numbers_as_written_or_a_clear_error(
    tmp_path_factory: pytest.TempPathFactory, content: bytes
) -> None:
    path = tmp_path_factory.mktemp("any") / "robot.csv"
    path.write_bytes(content)
    with contextlib.suppress(DataError):
        table = open_text(path)
        values, _ = table.read([0, 1], [])
        assert values.tolist() == written(table)


def written(table: DelimitedText) -> list[list[float]]:
    """The first two columns as Python reads them."""
    layout = table.layout
    with open(table.path, encoding=layout.encoding, newline="") as lines:
        rows = [row for _, row in rows_of(iter(lines.readlines()[layout.lines_above :]), layout.delimiter)]
    return [[float(cell.strip(" \t").replace(",", ".")) for cell in row[:2]] for row in rows[layout.header_rows :]]
