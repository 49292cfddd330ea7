from __future__ import annotations

import pandas as pd

from softkin.reporting.page.orientation import orientation_grid
from tests.unit.reporting.page.frames import NO_MARKS, TITLES, texts


def test_each_subset_and_level_has_its_row() -> None:
    row = {"dataset": "finger", "model": "gp", "subset": "test", "mean_deg": 1.0, "rms_deg": 1.5}
    row |= {"confidence_level": 0.9, "bound_deg": 3.0, "coverage": 0.875, "guarantee": "marginal"}
    grid = orientation_grid(pd.DataFrame([row, row | {"bound_deg": float("inf")}]), TITLES, NO_MARKS)
    expected = ["finger", "Gaussian process", "test", "1.00", "1.50", "90.0 %", "3.00", "87.5 %", "marginal"]
    assert texts(grid.rows[0]) == expected
    assert texts(grid.rows[1])[6] == "infinite"
    assert len(grid.columns) == len(expected)
