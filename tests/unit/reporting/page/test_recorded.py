"""The tables of robots in time."""

from __future__ import annotations

from softkin.reporting.page.recorded import recorded_grid
from tests.unit.reporting.page.frames import NO_MARKS, TITLES, recorded, texts


def test_each_score_in_time_has_its_row() -> None:
    grid = recorded_grid(recorded(), TITLES, NO_MARKS)
    assert len(grid.rows) == len(recorded())
    assert texts(grid.rows[1]) == [
        *("finger", "as published", "test", "Gaussian process, tuned", "play", "split conformal", "0"),
        *("0.530", "0.420", "85.0 %", "1.50", "2.20"),
    ]
    assert {row[1].text for row in grid.rows} == {"as published", "next session"}
