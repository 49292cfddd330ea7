from __future__ import annotations

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.table import claims_table
from tests.unit.reporting.claims.worlds import world


def test_a_judgement_says_why_it_cannot_be_decided() -> None:
    table = claims_table(CLAIMS, world(True), None).set_index("claim")
    assert table.loc["table_1_interpretability", "numbers"].startswith("it would take a definition")
