from __future__ import annotations

import pandas as pd

from softkin.reporting.page.extrapolation import outside_grid, searched_grid, spaces_grid
from softkin.reporting.page.marks import Marks
from tests.unit.reporting.page.conftest import ROBOTS, frames

MODELS = {"gp": "Gaussian process"}
MARKS = Marks({name: {} for name in ROBOTS}, {name: {"is_cut": False} for name in ROBOTS}, {})


def test_the_rank_correlation_of_each_robot_stands_in_the_sentence() -> None:
    grid = searched_grid(frames()["searched_runs"], MODELS, MARKS)
    assert all(f"{robot} 0.750 (0.250)" in grid.sentence for robot in ROBOTS)
    assert [cell.text for cell in grid.rows[0]][3:] == ["curvature", "1.00", "2.00", "1.00", "2.50"]


def test_a_target_space_stands_beside_the_other_and_the_sentence_counts() -> None:
    grid = spaces_grid(frames()["target_spaces"], MODELS, MARKS)
    assert [cell.text for cell in grid.rows[1]][1:] == [
        *("extrapolation", "Gaussian process", "curvature", "4.00", "1.00", "0.500", "0.500", "0.250"),
    ]
    assert f"the lower RMSE in {len(ROBOTS)} of {len(ROBOTS)} cases" in grid.sentence


def test_an_interval_stands_beside_the_oracle_and_a_refusal_says_why() -> None:
    table = frames()["extrapolation_intervals"]
    other = table.assign(confidence_level=0.8)
    grid = outside_grid(pd.concat([table, other]), MODELS, {"cps": "CPS"}, 0.9, MARKS)
    assert len(grid.rows) == len(table)
    assert [cell.text for cell in grid.rows[1]][1:] == [
        *("extrapolation", "Gaussian process", "tuned", "CPS", "91.0 %", "2.00", "3.00", "1.25"),
        *("no guarantee", "none", "too few rows"),
    ]
