from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import MemoryTable, from_cells, list_in, looked_at, number_of


@pytest.mark.parametrize(
    ("cell", "numbers"),
    [
        ("[1, 2.5]", [1.0, 2.5]),
        ("[np.float64(0.5), np.float64(-1e-3)]", [0.5, -1e-3]),
        ("[ 1.  2. ]", [1.0, 2.0]),
        ("(1, 2)", [1.0, 2.0]),
        ([[1, 2]], [1.0, 2.0]),
        ("[a, b]", None),
        ("[]", None),
        ("1.5", None),
        (1.5, None),
    ],
)
def test_lists_in_cells(cell: Any, numbers: Any) -> None:
    assert list_in(cell) == numbers


def test_a_column_of_lists_becomes_one_for_each_number() -> None:
    table = from_cells(["t", "x", "m1"], [[0, 1], ["[1, 2]", "[3, 4]"], [[5, 6], [7, 8]]])
    assert table.names == ("t", "x1", "x2", "m1_1", "m1_2")
    assert table.read([0, 1, 2, 4], [])[0].tolist() == [[0, 1, 2, 6], [1, 3, 4, 8]]
    with pytest.raises(DataError, match=r"row 1 \(the first is 0\), column 'x': cells hold lists, of 2 .* none here"):
        from_cells(["x"], [["[1, 2]", ""]])


def test_numbers_gaps_and_text_are_told_apart() -> None:
    assert [number_of(cell) for cell in (1, 2.5, "3,5", np.int64(4), True, "a")] == [1.0, 2.5, 3.5, 4.0, None, None]
    missing: Any = [number_of(cell) for cell in (None, "", "NaN", float("nan"))]
    assert np.isnan(missing).all()
    assert looked_at(["1", "", "a"]).dtype == object
    np.testing.assert_array_equal(looked_at(["1", "2", "", "a"]), [1.0, 2.0, np.nan, np.nan])
    np.testing.assert_array_equal(looked_at(["1,5", "2"]), [1.5, 2.0])
    assert looked_at(["", ""]).dtype == np.float64
    assert looked_at([]).dtype == np.float64


@given(st.lists(st.text("0123456789.+-eE, na", max_size=5), max_size=6))
def test_a_look_at_texts_takes_each_as_the_number_that_it_is(cells: list[str]) -> None:
    numbers = [number_of(cell) for cell in cells]
    seen = looked_at(cells)
    if seen.dtype == object:
        assert list(seen) == cells
    else:
        np.testing.assert_array_equal(seen, [np.nan if number is None else number for number in numbers])


def table() -> MemoryTable:
    return from_cells(["u", "x", "note"], [[1.0, 2.0, 3.0], [1.0, None, None], ["a", "b", "c"]])


def test_missing_numbers_are_nan_where_gaps_are_allowed_and_else_all_listed() -> None:
    values, (notes,) = table().read([0, 1], [2], gaps=True)
    np.testing.assert_array_equal(values, [[1, 1], [2, np.nan], [3, np.nan]])
    assert notes.tolist() == ["a", "b", "c"]
    with pytest.raises(DataError, match=r"row 1 .*, column 'x': no value \(rows with such problems: 2, rows 1, 2\)"):
        table().read([0, 1], [])
    with pytest.raises(DataError, match="column 'note': no finite number: 'a'"):
        table().read([2], [], gaps=True)
    with pytest.raises(DataError, match="no finite number: 'inf'"):
        from_cells(["x"], [[1.0, float("inf")]]).read([0], [], gaps=True)
