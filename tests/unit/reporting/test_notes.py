from __future__ import annotations

from typing import Any

from softkin.data.audit.findings import LEAK
from softkin.reporting.notes import subset_notes


def card(*subsets: str, severity: str = LEAK) -> dict[str, Any]:
    finding = {"severity": severity, "subsets": subsets, "sentence": "Rows are copies.", "consequence": "Do not trust."}
    return {"findings": [finding]}


def test_a_leak_stands_before_the_note_of_the_entry() -> None:
    notes = subset_notes(card("test"), {"test": "A note.", "validation": "Another."})
    assert notes == {"validation": "Another.", "test": "LEAK: Rows are copies. Do not trust. A note."}


def test_subsets_without_a_note_are_left_out() -> None:
    assert subset_notes({"findings": []}, {}) == {}
    assert subset_notes(card("test", severity="caution"), {}) == {}
    assert list(subset_notes(card("extrapolation", "validation"), {})) == ["validation", "extrapolation"]
