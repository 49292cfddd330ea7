"""Claims of the paper, and the extra row of its comparison."""

from __future__ import annotations

from typing import Any

import pandas as pd

from softkin.reporting.tables.claims import COLUMNS, claims, with_memory
from tests.unit.reporting.page.frames import recorded

MEMORY = {
    "remembers": {
        "lag_one": {"m1_x": 0.55, "m1_y": 0.63},
        "lag_one_within_sessions": {"m1_x": 0.3, "m1_y": 0.42},
        "p_value": 0.001,
    },
    "sessions_differ": {"effect_mm": {"m1_x": 1.9, "m1_y": 3.5}, "p_value": 0.001},
}


def card(*codes: str) -> dict[str, Any]:
    return {"checks": {"memory": MEMORY}, "findings": [{"code": code} for code in codes]}


def test_a_robot_that_remembers_refutes_the_claim_with_numbers() -> None:
    about = [{"dataset": "finger", "origin": "published"}, {"dataset": "arm", "origin": "own"}]
    table = claims(recorded(), about, [card("remembers"), card()])
    assert list(table.columns) == COLUMNS
    assert table["dataset"].tolist() == ["finger"]  # the paper says nothing of a robot of one's own
    assert table["verdict"].tolist() == ["does not hold"]
    numbers = table["numbers"][0]
    for number in ("at 0.63 in m1_y", "at 0.42", "up to 3.5 mm", "from 1.27 to 0.53 mm", "as little as 28%"):
        assert number in numbers


def test_without_a_finding_it_is_not_contradicted() -> None:
    table = claims(recorded(), [{"dataset": "finger", "origin": "published"}], [card()])
    assert table["verdict"].tolist() == ["not contradicted"]


def test_a_stand_in_says_nothing_of_the_paper() -> None:
    assert claims(recorded(), [{"dataset": "finger", "origin": "stand-in"}], [card("remembers")]).empty


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
