"""The tables of robots in time."""

from __future__ import annotations

import pandas as pd

from softkin.reporting.page.recorded import claims_grid, recorded_grid
from tests.unit.reporting.page.frames import NO_MARKS, TITLES, recorded, texts


def test_each_score_in_time_has_its_row() -> None:
    grid = recorded_grid(recorded(), TITLES, NO_MARKS)
    assert len(grid.rows) == len(recorded())
    assert texts(grid.rows[1]) == [
        *("finger", "as published", "test", "Gaussian process, tuned", "play", "split conformal", "0"),
        *("0.530", "0.420", "85.0 %", "1.50", "2.20"),
    ]
    assert {row[1].text for row in grid.rows} == {"as published", "next session"}


def test_a_claim_has_its_verdict_as_a_badge() -> None:
    row = {"claim": "it is so", "source": "the paper", "dataset": "finger", "numbers": "some"}
    table = pd.DataFrame([row | {"verdict": "does not hold"}, row | {"verdict": "not contradicted"}])
    rows = claims_grid(table).rows
    assert texts(rows[0]) == ["it is so", "finger", "does not hold", "some"]
    assert [row[2].verdict for row in rows] == ["worse", "reproduced"]
