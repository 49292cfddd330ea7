from __future__ import annotations

from typing import Any

import pytest

from softkin.core.errors import DataError
from softkin.data.readers.text_layout import layout_of


def layout(text: str, **options: Any) -> tuple[tuple[str, ...], str, int, int, tuple[str, ...]]:
    found = layout_of(text.encode(), True, **options)
    return found.names, found.delimiter, found.lines_above, found.header_rows, found.units


ROWS = "1,2.5,3\n4,5,6\n7,8,9\n"
NAMES = ("u1", "x", "y")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("u1,x,y\n" + ROWS, (NAMES, ",", 0, 1, ())),
        ("\n\nu1,x,y\n" + ROWS, (NAMES, ",", 2, 1, ())),
        ("# u1 x y\n" + ROWS, (NAMES, ",", 1, 0, ())),
        ("# run 3\n# u1, x, y\n" + ROWS, (NAMES, ",", 2, 0, ())),
        ("% made by hand\nu1,x,y\n" + ROWS, (NAMES, ",", 1, 1, ())),
        ("# u1 x y\n" + ROWS.replace(",", "   "), (NAMES, " ", 1, 0, ())),
        ("u1  x  y\n" + ROWS.replace(",", " \t "), (NAMES, " ", 0, 1, ())),
        ("log of a day\nlimbs,length\n3,0.1\nu1,x,y\n" + ROWS, (NAMES, ",", 3, 1, ())),
        ("log of a day\nu1;x;y\n" + ROWS.replace(",", ";").replace(".", ","), (NAMES, ";", 1, 1, ())),
        ("u1,x,y\nbar,mm,[mm]\n" + ROWS, (NAMES, ",", 0, 2, ("bar", "mm", "mm"))),
        ("u1,x,y\nleft,mm,mm\n" + ROWS, (NAMES, ",", 0, 1, ())),
    ],
)
def test_what_stands_above_the_rows_is_found(text: str, expected: Any) -> None:
    assert layout(text) == expected


def test_the_line_of_the_names_can_be_said() -> None:
    assert layout("1,2,3\nu1,x,y\n" + ROWS, header=2) == (NAMES, ",", 1, 1, ())
    assert layout(ROWS, header="none") == (("c1", "c2", "c3"), ",", 0, 0, ())
    with pytest.raises(DataError, match="no rows"):
        layout(ROWS, header=9)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (ROWS, "header: none into the entry"),
        ("# of quite another shape\n" + ROWS, "no header"),
        ("u1\n1\n2\n", "one column only"),
        ("# u1 x\n", "no rows"),
        ("u1,x\n", "a header, but no row"),
        ("", "the file is empty"),
    ],
)
def test_what_cannot_be_told_is_an_error_with_its_fix(text: str, says: str) -> None:
    with pytest.raises(DataError) as error:
        layout(text)
    assert says in str(error.value)
    assert error.value.fix


def test_a_header_that_is_too_short_is_no_preamble() -> None:
    """A row of numbers is never taken for names, and a header never passed over for rows of text."""
    assert layout("u1,x\n" + ROWS)[0] == ("u1", "x")
    assert layout("u1,x\n1,2,left\n3,4,right\n5,6,left\n")[0] == ("u1", "x")


@pytest.mark.parametrize(
    "text",
    [
        "Recorded in May,,\n,,\nu1,x,y\n1,2,3\n4,5,6\n",
        "0.1,3,\nu1,x,y\n1,2,3\n4,5,6\n",
        "Log,,\nu1,x,y\nbar,mm,mm\n1,2,3\n4,5,6\n",
    ],
)
def test_a_preamble_that_is_filled_up_with_empty_cells_is_no_header(text: str) -> None:
    assert layout_of(text.encode(), True).names == ("u1", "x", "y")


@pytest.mark.parametrize("text", ["u1,,y\n1,2,3\n4,5,6\n", "u1,,y\nbar,mm,mm\n1,2,3\n4,5,6\n"])
def test_a_header_with_an_empty_name_stays_one(text: str) -> None:
    assert layout_of(text.encode(), True).names == ("u1", "", "y")


@pytest.mark.parametrize("delimiter", ["\t", ";", "|", " "])
def test_decimal_commas_split_no_columns_also_without_a_header(delimiter: str) -> None:
    text = "\n".join(delimiter.join(["0,5", "-0,25", "12,125"]) for _ in range(5)) + "\n"
    assert layout(text, header="none")[:2] == (("c1", "c2", "c3"), delimiter)


@pytest.mark.parametrize("text", ["-0,25,1,5\n0,75,2,5\n", "1,05,2,5\n1,75,2,5\n"])
def test_commas_that_are_delimiter_and_decimal_mark_are_refused(text: str) -> None:
    with pytest.raises(DataError, match="decimal marks, too"):
        layout_of(text.encode(), True, header="none")
    assert layout_of(b"1,2,3\n4,5,0\n", True, header="none").names == ("c1", "c2", "c3")
