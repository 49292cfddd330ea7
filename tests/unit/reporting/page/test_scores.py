from __future__ import annotations

from softkin.reporting.page.choices import read_choices
from softkin.reporting.page.scores import choice_grid, interval_grid, point_grid
from softkin.reporting.page.singles import Singles
from softkin.reporting.tables.interval_choice import RATIO
from softkin.reporting.tables.single_rows import Hanging, Number
from tests.unit.reporting.page.frames import LEVELS, MODELS, NO_MARKS, PRESETS, ROBOTS, TITLES, frames, kinds, texts

CHOICES = read_choices(frames())


def test_every_run_has_its_errors_and_the_deployed_one_is_marked() -> None:
    table = frames()["point_metrics"]
    grid = point_grid(table, TITLES, NO_MARKS, CHOICES, Singles({}))
    assert len(grid.rows) == len(table)
    assert texts(grid.rows[2]) == [
        *("arm", "test", "Linear regression", "paper", *["0.0100"] * 5, "0.0100", "0.100", "2.00"),
    ]
    marked = {(row[0].text, row[2].text, row[3].text) for row in grid.rows if kinds(row[2]) == ["deployed"]}
    assert marked == {(robot, "Gaussian process", "tuned") for robot in ROBOTS}


def test_every_number_of_a_table_has_one_format() -> None:
    """Errors from 1e-4 to 1e4 mm stand in one column: none has an exponent."""
    grid = point_grid(frames()["point_metrics"], TITLES, NO_MARKS, CHOICES, Singles({}))
    errors = {row[4].text for row in grid.rows}
    assert {"0.000100", "1.00", "10000"} <= errors
    assert not any("e" in text for text in errors)


def test_one_row_per_interval_method_and_level() -> None:
    grid = interval_grid(frames()["interval_metrics"], TITLES, 0.9, NO_MARKS, CHOICES)
    n_methods = len(TITLES.methods)
    assert len(grid.rows) == len(ROBOTS) * 2 * len(MODELS) * len(PRESETS) * n_methods * len(LEVELS)
    level = next(column for column in grid.columns if column.title == "Level")
    assert (level.filtered, level.preset) == (True, "90 %")
    row = next(
        row for row in grid.rows if texts(row)[:6] == ["arm", "test", "System", "Gaussian process", "tuned", "90 %"]
    )
    assert kinds(row[2]) == ["chosen", "deployed"]
    assert texts(row)[6:] == ["90.0 %", "1 of 2", "70.0 %", "2.00", "3.00", "2.50", "infinite", "marginal"]


def test_of_two_robots_one_has_another_interval_deployed_than_chosen() -> None:
    grid = choice_grid(frames()["interval_choice"], TITLES, NO_MARKS, Singles({}))
    marked = [(row[0].text, row[1].text, kinds(row[1])) for row in grid.rows]
    assert marked == [
        ("arm", "System", ["chosen", "deployed"]),
        ("arm", "SCP (MAPIE)", []),
        ("finger", "CQR", ["chosen"]),
        ("finger", "System", ["deployed"]),
        ("finger", "SCP (MAPIE)", []),
    ]
    (reason,) = grid.remarks
    assert reason.startswith("finger: Chosen is CQR (Gradient boosting, tuned)")
    assert texts(grid.rows[0])[2:] == [
        *(
            "Gaussian process, tuned",
            "0.750",
            "1.00",
            "0.875",
            "90.0 %",
            "0.000000200",
            "3.00",
            "2.50",
            "–",
            "–",
            "Everywhere",
            "80.0 %",
        ),
    ]


def test_a_ratio_that_hangs_on_one_row_is_marked() -> None:
    choice = frames()["interval_choice"]
    row = choice.iloc[0]
    key = Number(row["dataset"], "test", row["model"], row["preset"], RATIO, row["interval_method"])
    grid = choice_grid(choice, TITLES, NO_MARKS, Singles({key: Hanging("row 3", 0.1, 2.0)}))
    place = [column.title for column in grid.columns].index("Ratio to the paper's")
    assert kinds(grid.rows[0][place]) == ["one row"]
    assert kinds(grid.rows[1][place]) == []
