"""Marks of numbers that hang on a single row."""

from __future__ import annotations

from typing import Any

import pandas as pd

from softkin.reporting.page.grid import Cell
from softkin.reporting.page.singles import Singles, read_singles
from softkin.reporting.tables.single_rows import Hanging, Number
from tests.unit.reporting.page.frames import kinds

RMSE, R2 = (Number("arm", "test", "gb", "paper", metric) for metric in ("rmse_mm", "r2"))
SINGLES = Singles({RMSE: Hanging("row 3", 2.0, 0.2), R2: Hanging("m1_x", 0.9, 0.4)})


def test_a_number_is_marked_by_what_it_hangs_on() -> None:
    cell = SINGLES.marked(Cell("2.00", verdict="better"), RMSE)
    assert (cell.text, cell.verdict, kinds(cell)) == ("2.00", "better", ["one row"])
    assert cell.marks[0].text.startswith("arm, test: without one row such a number changes by more than 5%")
    assert kinds(SINGLES.marked(Cell("0.9"), R2)) == ["one coordinate"]
    assert SINGLES.of(Number("arm", "test", "gb", "tuned", "rmse_mm")) == ()


def test_they_are_read_where_the_table_is() -> None:
    row: dict[str, Any] = {"dataset": "arm", "subset": "test", "left_out": "row 3", "model": "gb", "preset": "paper"}
    row |= {"interval_method": None, "metric": "rmse_mm", "value": 2.0, "without": 0.2}
    assert read_singles({"left_out": pd.DataFrame([row])}).of(RMSE)
    assert read_singles({}).of(RMSE) == ()
