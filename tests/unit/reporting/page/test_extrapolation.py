from __future__ import annotations

import pandas as pd

from softkin.reporting.page.choices import read_choices
from softkin.reporting.page.extrapolation import extrapolation_grid, searched_grid, spaces_grid
from tests.unit.reporting.page.frames import NO_MARKS, ROBOTS, TITLES, frames, kinds, texts

CHOICES = read_choices(frames())


def test_the_rank_correlation_of_each_robot_stands_in_the_sentence() -> None:
    grid = searched_grid(frames()["searched_runs"], TITLES, NO_MARKS, CHOICES)
    assert all(f"{robot} 0.750 (0.250)" in grid.sentence for robot in ROBOTS)
    assert texts(grid.rows[0])[3:] == ["curvature", "1.00", "2.00", "1.00", "2.50"]


def test_the_deployed_run_is_marked_among_the_searched() -> None:
    runs = frames()["searched_runs"]
    both = pd.concat([runs, runs.assign(model="lr")])
    marked = {(row[0].text, row[1].text): kinds(row[1]) for row in searched_grid(both, TITLES, NO_MARKS, CHOICES).rows}
    for robot in ROBOTS:
        assert marked[robot, "Gaussian process"] == ["deployed"]
        assert marked[robot, "Linear regression"] == []


def test_a_target_space_stands_beside_the_other_and_the_sentence_counts() -> None:
    grid = spaces_grid(frames()["target_spaces"], TITLES, NO_MARKS)
    assert texts(grid.rows[1])[1:] == [
        *("extrapolation", "Gaussian process", "curvature", "4.00", "1.00", "0.500", "0.500", "0.250"),
    ]
    assert f"the lower RMSE in {len(ROBOTS)} of {len(ROBOTS)} cases" in grid.sentence


def test_an_interval_stands_beside_the_oracle_and_a_refusal_says_why() -> None:
    table = frames()["extrapolation_intervals"]
    other = table.assign(confidence_level=0.8)
    grid = extrapolation_grid(pd.concat([table, other]), TITLES, 0.9, NO_MARKS, CHOICES)
    assert len(grid.rows) == len(table)
    assert texts(grid.rows[1])[1:] == [
        *(
            "extrapolation",
            "Gaussian process",
            "tuned",
            "Everywhere",
            "91.0 %",
            "85.0 %",
            "70.0 %",
            "2.00",
            "3.00",
            "1.25",
        ),
        *("1.20 to 1.30", "1.22", "40"),
        *("no guarantee", "none", "too few rows"),
    ]


def test_the_deployed_interval_is_marked_where_it_is_the_one_of_extrapolation() -> None:
    grid = extrapolation_grid(frames()["extrapolation_intervals"], TITLES, 0.9, NO_MARKS, CHOICES)
    marked = {(row[0].text, row[1].text): kinds(row[4]) for row in grid.rows}
    assert marked["finger", "extrapolation"] == ["deployed"]
    assert marked["arm", "extrapolation"] == ["chosen", "deployed"]
    assert marked["arm", "test"] == []  # there it is `cps`
