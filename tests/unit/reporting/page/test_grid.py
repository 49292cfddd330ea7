from __future__ import annotations

import csv
import io
from urllib.parse import unquote

import pytest

from softkin.reporting.page.grid import Cell, Column, Grid, filtered_columns, number, number_columns, share
from softkin.reporting.page.marks import Mark

LEAK, CUT = Mark("leak", "It leaks."), Mark("rows left out")


def grid(file: str = "") -> Grid:
    columns = [*filtered_columns("Robot", "Preset"), Column("Model"), *number_columns("RMSE (mm)")]
    rows = [
        [Cell("finger", (LEAK, CUT)), Cell("paper"), Cell("GP, tuned"), number(2.0)],
        [Cell("arm", (LEAK,)), Cell("paper"), Cell('the "best"'), number(None)],
        [Cell("finger"), Cell("paper"), Cell("GP"), number(4.12e-4)],
    ]
    return Grid("errors", "Errors", "What they are.", columns, rows, file)


def test_a_menu_has_the_values_of_its_column_once_and_one_value_needs_none() -> None:
    ((place, column, values),) = grid().menus
    assert (place, column.title, values) == (0, "Robot", ["finger", "arm"])


def test_marks_with_words_stand_below_the_table_once() -> None:
    assert grid().notes == [LEAK]


def test_a_table_with_a_file_links_to_it() -> None:
    assert grid("tables/errors.csv").link == "tables/errors.csv"


def test_a_table_without_a_file_carries_its_csv() -> None:
    kind, _, content = grid().link.partition(",")
    assert kind == "data:text/csv;charset=utf-8"
    assert list(csv.reader(io.StringIO(unquote(content)))) == [
        ["Robot", "Preset", "Model", "RMSE (mm)"],
        ["finger", "paper", "GP, tuned", "2.00"],
        ["arm", "paper", 'the "best"', "–"],
        ["finger", "paper", "GP", "0.000412"],
    ]


@pytest.mark.parametrize(("cell", "text"), [(number(float("inf")), "infinite"), (share(0.914), "91.4 %")])
def test_cells_of_numbers(cell: Cell, text: str) -> None:
    assert cell == Cell(text)
