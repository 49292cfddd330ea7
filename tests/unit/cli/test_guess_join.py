from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from softkin.cli.guess_join import guess_join
from softkin.core.errors import DataError
from softkin.data.readers.memory_table import MemoryTable


def table(**columns: Any) -> MemoryTable:
    return MemoryTable(tuple(columns), tuple(np.asarray(column, dtype=float) for column in columns.values()))


def of(*tables: MemoryTable, wanted: str | None = None) -> tuple[dict[str, Any], str]:
    join, (why,) = guess_join([(f"{'abc'[n]}.csv", one) for n, one in enumerate(tables)], wanted)
    return join, why


TEN = np.arange(10.0)
LOG, TAKE = table(t=TEN / 10, u1=TEN), table(**{"Time (s)": np.arange(120) / 120}, x=np.arange(120.0))


def test_a_column_of_equal_values_joins() -> None:
    join, why = of(table(ID=TEN, u1=TEN), table(ID=TEN[::-1], x=TEN))
    assert join == {"by": "column", "column": "ID"}
    assert "10 values in all files; please check" in why
    repeated = table(trial=np.repeat(TEN, 3), x=np.arange(30.0))
    assert of(table(trial=TEN, u1=TEN), repeated)[0] == {"by": "column", "column": "trial"}


def test_times_join_by_the_nearest_one_step_away() -> None:
    join, why = of(LOG, TAKE)
    assert join == {"by": "time", "column": ["t", "Time (s)"], "tolerance": 0.00833}
    assert "write resample: hold" in why
    assert of(table(t=TEN, u1=TEN), table(t=TEN, x=TEN))[0] == {"by": "time", "column": "t", "tolerance": 1.0}


def test_clocks_that_never_meet_are_taken_to_start_together() -> None:
    join, why = of(table(t=TEN + 1e6, u1=TEN), table(t=TEN, x=TEN))
    assert join["offset"] == 1e6
    assert "their times do not overlap" in why


def test_rows_join_where_nothing_else_does_and_another_way_is_named() -> None:
    assert of(table(u1=TEN), table(x=TEN))[0] == {"by": "row"}
    join, why = of(table(ID=TEN, t=TEN, u1=TEN), table(ID=TEN, t=TEN, x=TEN))
    assert join["by"] == "column"
    assert why.endswith("or is it join: {by: time, column: t, tolerance: 1.0}?")
    assert of(table(ID=TEN, u1=TEN), table(ID=TEN, x=TEN), wanted="row")[0] == {"by": "row"}


def test_nothing_to_join_by_is_an_error_with_all_columns() -> None:
    with pytest.raises(DataError, match=r"nothing tells how .* \(a.csv: u1; b.csv: x\)"):
        of(table(u1=TEN), table(x=TEN[:5]))
    with pytest.raises(DataError, match="belong together by time"):
        of(table(ID=TEN, u1=TEN), table(ID=TEN, x=TEN), wanted="time")


def test_dates_are_times_and_times_in_other_units_are_refused() -> None:
    dates = np.array([f"2024-05-31 12:00:{second:02d}" for second in range(10)], dtype=object)
    log = MemoryTable(("date", "u1"), (dates, TEN))
    assert of(log, table(t=TEN, x=TEN))[0]["offset"] == 1717156800.0
    with pytest.raises(DataError, match=r"different units\? 't' goes on for 9, 'time_ms' for 9000"):
        of(table(t=TEN, u1=TEN), table(time_ms=TEN * 1000, x=TEN))


def test_rows_that_are_counted_from_0_and_from_1_are_asked_for() -> None:
    assert "starts at 0 and at 1: are rows counted alike?" in of(table(ID=TEN, u1=TEN), table(ID=TEN + 1, x=TEN))[1]


def test_times_that_tell_nothing_are_no_reason_to_count_rows() -> None:
    with pytest.raises(DataError, match="nothing tells"):
        of(table(t=TEN[::-1], u1=TEN), table(t=TEN, x=TEN))
