from __future__ import annotations

import pandas as pd

from softkin.reporting.page.published import best_grid, cells_grid, intervals_grid
from tests.unit.reporting.page.frames import NO_MARKS, TITLES, frames, texts


def test_the_best_of_a_column_stands_beside_the_papers_best() -> None:
    grid = best_grid(frames()["published_columns"], TITLES, NO_MARKS)
    assert texts(grid.rows[0]) == [
        *("arm", "test", "RMSE (mm)", "1.40", "Gradient boosting", "1.20", "Gaussian process", "worse"),
    ]
    assert grid.rows[0][-1].verdict == "worse"


def test_a_cell_has_value_and_verdict_of_each_preset_that_was_run() -> None:
    cells = frames()["published_comparison"]
    grid = cells_grid(cells, TITLES, NO_MARKS)
    assert [column.title for column in grid.columns[5:]] == [
        *("Ours, paper", "Verdict, paper", "Ours, tuned", "Verdict, tuned"),
    ]
    assert texts(grid.rows[0])[3:] == ["RMSE (mm)", "1.40", "1.40", "reproduced", "1.20", "better"]
    with_outer = cells.assign(outer_value=1.3, outer_verdict=pd.NA)
    grid = cells_grid(with_outer, TITLES, NO_MARKS)
    assert [column.title for column in grid.columns[-2:]] == ["Ours, outer", "Verdict, outer"]
    assert texts(grid.rows[0])[-2:] == ["1.30", "–"]  # not scored, no verdict


def test_the_badge_of_table_6_is_that_of_the_average() -> None:
    grid = intervals_grid(frames()["published_intervals"], TITLES, NO_MARKS)
    (row,) = grid.rows
    assert texts(row) == ["arm", "SCP (MAPIE)", "Coverage", "0.90", "0.500", "lower"]
    assert row[-1].verdict == "lower"


def test_what_comes_nearest_is_a_footnote_that_names_its_freedom() -> None:
    general, of_cell = intervals_grid(frames()["published_intervals"], TITLES, NO_MARKS).remarks
    assert "decide nothing" in general
    assert of_cell == (
        "arm, SCP (MAPIE): of 840 combinations m1_z, System around Gradient boosting, paper at 95 %: "
        "0.900 (printed 0.90)."
    )
