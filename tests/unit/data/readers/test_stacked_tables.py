from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.joined_tables import JoinedTables
from softkin.data.readers.memory_table import MemoryTable
from softkin.data.readers.stacked_tables import StackedTables


def table(**columns: Any) -> MemoryTable:
    arrays = tuple(
        np.array(column, dtype=None if isinstance(column[0], float) else object) for column in columns.values()
    )
    return MemoryTable(tuple(columns), arrays, lambda row: f"line {row + 2}")


FIRST, SECOND = table(u=[0.1, 0.2], x=[1.0, 2.0]), table(x=[3.0, 4.0, 5.0], u=[0.3, 0.4, 0.5])


def test_trials_stand_one_below_the_other_and_a_column_numbers_them() -> None:
    both = StackedTables([("a.csv", FIRST), ("b.csv", SECOND)])
    assert both.names == ("session", "u", "x")
    values, (session,) = both.read([1, 2], [0])
    assert values.tolist() == [[0.1, 1], [0.2, 2], [0.3, 3], [0.4, 4], [0.5, 5]]
    assert session.tolist() == [1, 1, 2, 2, 2]
    assert [both.place(row) for row in (0, 1, 2, 4)] == [
        f"file {p}" for p in ("a.csv, line 2", "a.csv, line 3", "b.csv, line 2", "b.csv, line 4")
    ]
    assert both.unjoined is None
    assert next(column.tolist() for column in both.look()) == [1, 1, 2, 2, 2]
    assert both.read([0], [])[0].ravel().tolist() == [1, 1, 2, 2, 2]


def test_sessions_within_files_stay_apart() -> None:
    trials = [table(u=[0.1, 0.2], session=["x", "y"]), table(u=[0.3], session=["x"])]
    both = StackedTables([("a.csv", trials[0]), ("b.csv", trials[1])])
    assert both.names == ("session", "u")
    assert both.read([1], [0])[1][0].tolist() == ["1 x", "1 y", "2 x"]


def test_a_session_that_a_file_does_not_say_is_none() -> None:
    both = StackedTables([(name, table(u=[0.1, 0.2], session=["x", None])) for name in ("a.csv", "b.csv")])
    assert both.read([1], [0])[1][0].tolist() == ["1 x", None, "2 x", None]


def test_trials_of_other_columns_and_bad_values_name_their_file() -> None:
    with pytest.raises(DataError, match=r"file b.csv: columns differ from those of a.csv: x, y"):
        StackedTables([("a.csv", FIRST), ("b.csv", table(u=[1.0], y=[2.0]))])
    bad = StackedTables([("a.csv", FIRST), ("b.csv", table(u=["soon"], x=[2]))])
    with pytest.raises(DataError, match=r"file b.csv, line 2, column 'u'"):
        bad.read([1], [])


def test_trials_of_joined_parts_say_which_rows_lack_a_partner() -> None:
    parts = [
        JoinedTables(
            [("u.csv", table(ID=[1, 2], u=[0.1, 0.2])), ("x.csv", table(ID=ids, x=[1.0, 2.0]))],
            {"by": "column", "column": "ID"},
        )
        for ids in ([1, 2], [2, 3])
    ]
    both = StackedTables([("u.csv, x.csv", part) for part in parts])
    values, _ = both.read([both.names.index("u"), both.names.index("x")], [])
    np.testing.assert_array_equal(values, [[0.1, 1], [0.2, 2], [0.1, np.nan], [0.2, 1]])
    assert both.unjoined is not None
    assert both.unjoined.tolist() == [False, False, True, False]
    assert both.place(3) == "file u.csv, line 3 with file x.csv, line 2"


def test_trials_in_other_units_are_refused() -> None:
    one, other = (MemoryTable(("x",), (np.ones(3),), units=(unit,)) for unit in ("m", "mm"))
    with pytest.raises(DataError, match="'x' in m there, in mm here") as raised:
        StackedTables([("a.csv", one), ("b.csv", other)])
    assert raised.value.where == "file b.csv"
