"""The paper's claims on the page."""

from __future__ import annotations

import pandas as pd

from softkin.reporting.claims.spec import VERDICTS
from softkin.reporting.page.claims import claims_grid
from tests.unit.reporting.page.frames import texts


def test_a_claim_has_its_verdict_as_a_badge() -> None:
    row = {
        "text": "it is so",
        "where": "table 1",
        "settings": None,
        "numbers": "some",
        "rule": "this",
        "decided_by": None,
    }
    rows = claims_grid(pd.DataFrame([row | {"verdict": verdict} for verdict in VERDICTS])).rows
    assert texts(rows[2]) == ["it is so", "table 1", "does not hold", "", "some", "this", ""]
    assert [row[2].verdict for row in rows] == ["better", "reproduced", "worse", ""]
