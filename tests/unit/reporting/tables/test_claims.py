"""Claims of the paper, and the extra row of its comparison."""

from __future__ import annotations

from typing import Any

import pandas as pd

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import VERDICTS
from softkin.reporting.tables.claims import claims, with_memory
from tests.unit.reporting.claims.worlds import DATASETS, RIGHT, card, descriptions, frames
from tests.unit.reporting.page.frames import recorded

LEFT_OUT = pd.DataFrame(columns=["dataset", "subset", "left_out"], dtype=str)


def test_every_claim_has_a_verdict_of_the_run() -> None:
    measured = frames(True, RIGHT) | {"left_out": LEFT_OUT}
    printed = {name: measured.pop(name) for name in ("subsets", "approaches", "improvements")}
    table = claims(measured, printed, descriptions(True), [card(name, True) for name in DATASETS])
    assert table["claim"].tolist() == list(CLAIMS)
    assert table["verdict"].isin(VERDICTS).all()


def test_a_run_without_published_data_says_nothing_of_the_paper() -> None:
    about = [of | {"origin": "stand-in"} for of in descriptions(True)]
    assert claims({}, {}, about, []).empty


def test_the_comparison_has_what_memory_makes_of_the_same_file() -> None:
    sources: dict[str, dict[str, Any]] = {
        "plain": {"sha256": "a", "paper_table": 5},
        "finger": {"sha256": "a"},
        "other": {"sha256": "b"},
    }
    [sentence] = with_memory("plain", sources, recorded())
    assert sentence == "With memory and session (finger: gp, tuned), test: RMSE 0.53 mm, MAE 0.42 mm."
    assert with_memory("finger", sources, recorded()) == []
    assert with_memory("other", sources, recorded()) == []
    assert with_memory("plain", sources, None) == []
    assert with_memory("plain", sources, pd.DataFrame(recorded().iloc[:0])) == []
