from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from softkin.data.readers.bad_rows import Layout, first_bad_row

NAMES = ("u", "note", "x")
POINTS = Layout(NAMES, (0, 2), "semicolon", ".")
COMMAS = Layout(NAMES, (0, 2), "semicolon", ",")


def rows(*cells: str) -> list[tuple[int, list[str]]]:
    """A good row on line 2, then one with `cells`."""
    return [(2, ["1", "good", "2"]), (3, list(cells))]


@pytest.mark.parametrize(
    ("layout", "cells"),
    [
        (POINTS, ("1.5", "", "-2e3")),
        (POINTS, (" 1.5\t", "anything", "+.5")),
        (POINTS, ("1.", "1,5", "1E-300")),
        (COMMAS, ("1,5", "nan", ",5")),
        (COMMAS, ("3", "", "-2,5e3")),
        (COMMAS, ("1,234", "", "5,678")),
    ],
)
def test_good_rows_have_no_error(layout: Layout, cells: tuple[str, ...]) -> None:
    assert first_bad_row(rows(*cells), layout) is None
    assert first_bad_row([], layout) is None


@pytest.mark.parametrize(
    ("layout", "cells", "where", "what", "fix"),
    [
        (POINTS, ("1", "b"), "line 3", "2 values, but the header names 3 columns", "separated by semicolon"),
        (POINTS, ("1", "b", "2", ""), "line 3", "4 values, but the header names 3 columns", "`delimiter` of the entry"),
        (POINTS, ("1", "b", " "), "line 3, column 'x'", "no value", "fill the cell"),
        (POINTS, ("1", "b", "NaN"), "line 3, column 'x'", "no finite number: 'NaN'", "fill the cell"),
        (POINTS, ("-inf", "b", "1"), "line 3, column 'u'", "no finite number: '-inf'", "delete the row"),
        (POINTS, ("1e999", "b", "1"), "line 3, column 'u'", "too large a number: '1e999'", "correct the value"),
        (POINTS, ("1,5", "b", "1"), "line 3, column 'u'", "'1,5', where other numbers have decimal points", "one"),
        (COMMAS, ("1.5", "b", "1"), "line 3, column 'u'", "'1.5', where other numbers have decimal commas", "one"),
        (POINTS, ("1,234.5", "b", "1"), "line 3, column 'u'", "a separator of thousands: '1,234.5'", "without"),
        (COMMAS, ("1 234,5", "b", "1"), "line 3, column 'u'", "a separator of thousands: '1 234,5'", "without"),
        (POINTS, ("1_000", "b", "1"), "line 3, column 'u'", "no number: '1_000'", "leave the column out"),
        (POINTS, ("\u0661", "b", "1"), "line 3, column 'u'", "no number: '\u0661'", "correct the cell"),
        (POINTS, ("a" * 99, "b", "1"), "line 3, column 'u'", f"no number: '{'a' * 40}'", "correct the cell"),
    ],
)
def test_a_bad_row_is_named_with_its_fix(
    layout: Layout, cells: tuple[str, ...], where: str, what: str, fix: str
) -> None:
    error = first_bad_row(rows(*cells), layout)
    assert error is not None
    assert (error.where, error.what) == (where, what)
    assert fix in str(error.fix)


def test_the_first_bad_row_is_named_and_all_are_counted() -> None:
    error = first_bad_row([(2, ["1", "", "2"]), (4, ["", "", "2"]), (5, ["1", "", "x"]), (9, ["1"])], POINTS)
    assert error is not None
    assert error.where == "line 4, column 'u'"
    assert error.what == "no value (rows with such problems: 3, lines 4, 5, 9)"


@given(st.floats(allow_nan=False), st.sampled_from([POINTS, COMMAS]))
def test_a_float_is_good_if_it_is_finite(value: float, layout: Layout) -> None:
    cell = repr(value).replace(".", layout.mark)
    assert (first_bad_row(rows(cell, "", "1"), layout) is None) == math.isfinite(value)


@given(st.text("0123456789.,eE+-_ \t nainf", max_size=12))
def test_a_cell_is_good_if_python_reads_a_finite_number(cell: str) -> None:
    def number(text: str) -> Any:
        try:
            return float(text.strip(" \t"))
        except ValueError:
            return math.nan

    expected = math.isfinite(number(cell)) and "_" not in cell
    assert (first_bad_row(rows(cell, "", "1"), POINTS) is None) == expected
