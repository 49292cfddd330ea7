from __future__ import annotations

import re
import sys
from pathlib import Path

import pandas as pd
import pytest

from softkin.reporting.claims import CLAIMS
from tests.conftest import HOUSE
from tools.claims_page import HEAD, main, make_claims_page


@pytest.fixture
def results(tmp_path: Path) -> Path:
    row: dict[str, str | None] = {
        "where": "table 1",
        "settings": "paper",
        "numbers": "paper: 2 of 2",
        "rule": "a is smaller than b",
    }
    row |= {"table": "point_metrics.csv", "command": "make run", "decided_by": None}
    rows = [
        row | {"claim": "one", "text": "it is so", "verdict": "holds with these settings"},
        row
        | {"claim": "two", "text": "so it is", "verdict": "does not hold", "settings": None}
        | {"decided_by": "the verdict: without finger test, row 7 it is 'holds'"},
    ]
    (tmp_path / "tables").mkdir()
    pd.DataFrame(rows).to_csv(tmp_path / "tables" / "claims.csv", index=False)
    return tmp_path


def test_each_claim_has_its_line_and_its_section(results: Path) -> None:
    make_claims_page(results, results / "claims.md")
    page = (results / "claims.md").read_text()
    assert "Of 2 claims: 0 holds; 1 holds with these settings; 1 does not hold; 0 not assessable." in page
    assert "| [it is so](#one) | table 1 | **holds with these settings** | paper | no |" in page
    assert "| [so it is](#two) | table 1 | **does not hold** |  | yes |" in page
    assert '## one\n\n"it is so" (table 1): **holds with these settings** (paper).\n' in page
    assert "- One row decides: the verdict: without finger test, row 7 it is 'holds'." in page


def test_a_run_without_the_table_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "argv", ["claims_page", "--results", str(tmp_path), "--page", str(tmp_path / "page.md")])
    assert main() == 1
    assert "no such table" in capsys.readouterr().err


def test_our_own_page_has_every_claim_of_the_registry_as_it_is_now() -> None:
    """After an edit of a claim: `make results-page`."""
    page = " ".join((HOUSE / "docs" / "claims.md").read_text().split())
    assert " ".join(HEAD.split()) in page
    assert re.findall(r"## (\w+) \"", page) == list(CLAIMS)
    for claim in CLAIMS.values():
        assert f'"{claim.text}" ({claim.where})' in page
        assert claim.rule_text in page
