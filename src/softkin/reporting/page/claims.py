"""The table of the paper's claims, with verdicts."""

from __future__ import annotations

import pandas as pd

from softkin.reporting.claims.spec import DOES_NOT, HOLDS, HOLDS_WITH, NOT_ASSESSABLE
from softkin.reporting.page.grid import Cell, Column, Grid, filtered_columns

#: How a verdict looks: a class of the style sheet.
LOOKS = {HOLDS: "better", HOLDS_WITH: "reproduced", DOES_NOT: "worse", NOT_ASSESSABLE: ""}


def claims_grid(claims: pd.DataFrame) -> Grid:
    """One row per claim."""
    rows = [
        [
            *(Cell(row.text), Cell(row.where), Cell(row.verdict, verdict=LOOKS[row.verdict]), Cell(row.settings)),
            *(Cell(row.numbers), Cell(row.rule), Cell(row.decided_by)),
        ]
        for row in claims.fillna("").itertuples()
    ]
    sentence = (
        "What the paper says, and what the numbers of this run make of it. A claim holds with these settings where it "
        "holds with some of the presets, regimes or columns that are named, and not with the others. The rules are the "
        "same for every run; the last column names single rows without which a verdict or a comparison would be "
        "another."
    )
    shown = [Column("Claim", is_wide=True), Column("Where", is_wide=True), *filtered_columns("Verdict")]
    shown += [Column(title, is_wide=True) for title in ("With", "Numbers", "Compared is", "Decided by one row")]
    return Grid("claims", "Claims", sentence, shown, rows, "tables/claims.csv")
