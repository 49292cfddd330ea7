from __future__ import annotations

import pandas as pd

from softkin.models.paper_groups import ALL
from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import DOES_NOT, HOLDS
from softkin.reporting.claims.table import COLUMNS, claims_table
from tests.unit.reporting.claims.worlds import RIGHT, world

NAME = "ensembles_most_robust"


def left_out(factor: float) -> pd.DataFrame:
    """Without row 7 of FINGER's test, with the paper's settings, SVR errs by that factor of what it does."""
    return pd.DataFrame(
        {"dataset": "finger", "subset": "test", "left_out": "row 7", "model": model, "preset": "paper"}
        | {
            "interval_method": "",
            "metric": "rmse_mm",
            "value": RIGHT[model],
            "without": RIGHT[model] * (factor if model == "svr" else 1.0),
        }
        for model in ALL
    )


def row_of(table: pd.DataFrame, name: str = NAME) -> dict[str, str]:
    [row] = table[table["claim"] == name].to_dict("records")
    return {str(key): value for key, value in row.items()}


def test_each_claim_has_its_row_with_what_decides() -> None:
    table = claims_table(CLAIMS, world(True), None)
    assert list(table.columns) == COLUMNS
    assert table["claim"].tolist() == list(CLAIMS)
    row = row_of(table)
    assert (row["verdict"], row["settings"], row["decided_by"]) == (HOLDS, "paper; tuned; outer", "")
    assert "paper: 8 of 8 (" in row["numbers"]
    assert "finger test" in row["numbers"]
    assert row["command"] == "make run"


def test_a_row_that_turns_a_comparison_is_named() -> None:
    row = row_of(claims_table(CLAIMS, world(True), left_out(0.4)))
    assert row["decided_by"] == "paper, finger test: turned by finger test, row 7, not the verdict"
    assert row_of(claims_table(CLAIMS, world(True), left_out(1.1)))["decided_by"] == ""


def test_a_row_that_turns_the_verdict_is_named() -> None:
    """LR and LASSO fail on FINGER where both are twice as bad as the best, on both subsets."""
    table = claims_table(CLAIMS, world(True), left_out(2.0).assign(without=3.0))
    row = row_of(table, "linear_fail_on_finger")
    assert row["verdict"] == HOLDS
    assert row["decided_by"] == (
        "the verdict: without finger test, row 7 it is 'holds with these settings (tuned; outer)'"
    )
    assert row_of(table, "sizes")["decided_by"] == ""  # no mean over rows


def test_a_claim_that_fails_with_all_settings_names_none() -> None:
    row = row_of(claims_table(CLAIMS, world(False), None))
    assert (row["verdict"], row["settings"]) == (DOES_NOT, "")
