from __future__ import annotations

import logging
from typing import Any

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.joined_tables import JOINS, JoinedTables
from softkin.data.readers.memory_table import MemoryTable


def table(units: tuple[str, ...] = (), **columns: Any) -> MemoryTable:
    kinds = [None if isinstance(column[0], float) else object for column in columns.values()]
    arrays = tuple(np.asarray(column, dtype=kind) for column, kind in zip(columns.values(), kinds, strict=True))
    return MemoryTable(tuple(columns), arrays, lambda row: f"line {row + 2}", units)


COMMANDS = table(ID=[3, 1, 2], u=[0.3, 0.1, 0.2])
POSITIONS = table(("", "mm"), ID=[1, 2, 3], x=[10.0, 20.0, 30.0])


def joined(*tables: MemoryTable, **join: Any) -> JoinedTables:
    return JoinedTables([(f"{'abc'[n]}.csv", one) for n, one in enumerate(tables)], join)


def test_rows_of_equal_values_are_one_row_in_the_order_of_the_first_file() -> None:
    both = joined(COMMANDS, POSITIONS, by="column", column="ID")
    assert both.names == ("ID", "u", "b.ID", "x")
    assert both.units == ("", "", "", "mm")
    values, (ids,) = both.read([3, 1], [0])
    assert values.tolist() == [[30.0, 0.3], [10.0, 0.1], [20.0, 0.2]]
    assert ids.tolist() == [3, 1, 2]
    assert both.place(0) == "file a.csv, line 2 with file b.csv, line 4"
    assert [column.tolist() for column in both.look()][3] == [30.0, 10.0, 20.0]


def test_rows_without_a_value_belong_to_no_row(caplog: pytest.LogCaptureFixture) -> None:
    commands = table(ID=["1", "2", "", ""], u=[0.1, 0.2, 0.3, 0.4])
    both = joined(commands, table(ID=["1", "1", "2", "", "3"], x=[1.0, 2.0, 3.0, 4.0, 5.0]), by="column", column="ID")
    with caplog.at_level(logging.INFO, logger="softkin"):
        values = both.read([1, 3], [])[0]
    np.testing.assert_array_equal(values, [[0.1, 1], [0.1, 2], [0.2, 3], [np.nan, 4], [np.nan, 5]])
    assert both.unjoined.tolist() == [False, False, False, True, True]
    assert "2 of 4 rows of a.csv have no partner" in caplog.text


def test_each_row_of_a_file_of_repeated_values_has_its_partner() -> None:
    frames = table(trial=[1, 1, 2, 3], x=[1.0, 2.0, 3.0, 4.0])
    both = joined(COMMANDS, frames, by="column", column=["ID", "trial"])
    assert both.read([3, 1], [])[0].tolist() == [[1.0, 0.1], [2.0, 0.1], [3.0, 0.2], [4.0, 0.3]]
    with pytest.raises(DataError, match=r"stand in several rows"):
        joined(frames, frames, by="column", column="trial").read([1], [])


def test_rows_without_partner_have_gaps_and_are_counted(caplog: pytest.LogCaptureFixture) -> None:
    fewer = table(ID=[3, 9], x=[30.0, 90.0])
    with caplog.at_level(logging.INFO, "softkin"):
        both = joined(COMMANDS, fewer, by="column", column="ID")
        values, _ = both.read([1, 3], [])
    np.testing.assert_array_equal(values, [[0.3, 30.0], [0.1, np.nan], [0.2, np.nan]])
    assert both.unjoined.tolist() == [False, True, True]
    assert "2 of 3 rows have no partner" in caplog.text
    with pytest.raises(DataError, match=r"no row of it has a partner"):
        joined(COMMANDS, table(ID=[8, 9], x=[1.0, 2.0]), by="column", column="ID").read([1], [])


def test_gaps_of_rows_that_have_partners_are_refused_and_others_not() -> None:
    gaps = table(ID=[1, 2, 3, 4], x=[1.0, np.nan, 3.0, np.nan])
    both = joined(COMMANDS, gaps, by="column", column="ID")
    with pytest.raises(DataError, match=r"file b.csv, line 3, column 'x': no value\n"):
        both.read([1, 3], [])
    np.testing.assert_array_equal(both.read([3], [], gaps=True)[0].ravel(), [3.0, 1.0, np.nan])
    two = table(ID=[1, 4], u=[0.1, 0.4])
    with pytest.raises(DataError, match=r"file b.csv, line 5"):
        joined(two, gaps, by="column", column="ID").read([1, 3], [])


def test_by_time_with_an_offset_and_a_rule() -> None:
    log, take = (
        table(t=[0.0, 1.0, 2.0], u=[0.0, 0.1, 0.2]),
        table(time=[10.1, 11.1, 11.4, 19.0], x=[1.0, 2.0, 4.0, 9.0]),
    )
    join: dict[str, Any] = {"by": "time", "column": ["t", "time"], "tolerance": 0.5, "offset": -10.0}
    assert joined(log, take, **join).unjoined.tolist() == [False, False, True]
    for rule, x in (("nearest", [1, 2]), ("mean", [1, 3])):
        assert joined(log, take, **join, resample=rule).read([3], [])[0][:2].ravel().tolist() == x
    assert joined(take, log, **join | {"column": ["time", "t"], "offset": 10.0, "resample": "hold"}).read([3], [])[0][
        :3
    ].ravel().tolist() == [0.0, 0.1, 0.1]
    with pytest.raises(DataError, match=r"runs from 0.0 to 2.0, that of the other from 10.1 to 19.0"):
        joined(log, take, by="time", column=["t", "time"], tolerance=0.5).read([3], [])


def test_row_by_row_needs_as_many_rows() -> None:
    assert joined(COMMANDS, POSITIONS, by="row").read([1, 3], [])[0].tolist() == [[0.3, 10.0], [0.1, 20.0], [0.2, 30.0]]
    with pytest.raises(DataError, match=r"a.csv 3, b.csv 2"):
        joined(COMMANDS, table(x=[1.0, 2.0]), by="row").read([0], [])


def test_a_bad_value_and_a_column_that_is_none_name_their_file() -> None:
    with pytest.raises(DataError, match=r"file b.csv, line 2, column 'x': no finite number: 'lost'"):
        joined(COMMANDS, table(ID=[1, 2, 3], x=["lost", 1, 2]), by="column", column="ID").read([3], [])
    with pytest.raises(DataError, match=r"file b.csv, `join`: no column 'ID'"):
        joined(COMMANDS, table(x=[1.0, 2.0, 3.0]), by="column", column="ID").read([1], [])
    with pytest.raises(DataError, match=r"3 columns for 2 files"):
        joined(COMMANDS, POSITIONS, by="column", column=["ID", "ID", "x"]).read([1], [])
    assert list(JOINS) == ["column", "time", "row"]
