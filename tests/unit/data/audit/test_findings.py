from __future__ import annotations

import json

import numpy as np

from softkin.data.audit.findings import (
    LEAK,
    MAX_ROWS_LISTED,
    NEIGHBOURS_IN_TIME,
    NOTE,
    WARNING,
    Finding,
    counted,
    finding_of_rows,
    leak_notes,
    leaking_subsets,
    worst_severity,
)


def test_rows_are_listed_up_to_a_limit_and_all_counted() -> None:
    marked = {
        "train": np.ones(1000, dtype=bool),
        "test": np.array([False, True]),
        "validation": np.zeros(5, dtype=bool),
    }
    finding = finding_of_rows("code", WARNING, marked, "Sentence.", "Consequence.")
    assert finding.subsets == ("train", "test")
    assert finding.rows["train"] == tuple(range(MAX_ROWS_LISTED))
    assert finding.rows["test"] == (1,)
    assert finding.n_rows == {"train": 1000, "test": 1}
    assert json.loads(json.dumps(finding.as_dict()))["rows"]["test"] == [1]


def test_the_worst_severity_wins() -> None:
    findings = [Finding("code", severity, (), "", "") for severity in (NOTE, LEAK, WARNING)]
    assert worst_severity(findings) == LEAK
    assert worst_severity(findings[:1]) == NOTE
    assert worst_severity([]) is None


def test_a_single_row_is_singular() -> None:
    assert [counted(n, "row") for n in (0, 1, 2)] == ["0 rows", "1 row", "2 rows"]


def test_only_a_leak_makes_a_subset_leak() -> None:
    findings = [
        Finding("copies", LEAK, ("test", "validation"), "", "").as_dict(),
        Finding("shift", WARNING, ("extrapolation",), "", "").as_dict(),
    ]
    assert leaking_subsets({"findings": findings}) == {"test", "validation"}
    assert leaking_subsets({"findings": []}) == set()


def test_the_notes_of_a_card_are_those_of_its_leaks_by_subset() -> None:
    findings = [
        Finding("copies", LEAK, ("test",), "Copied.", "Training error.").as_dict(),
        Finding("near_copies", LEAK, ("test", "validation"), "Nearly copied.", "Too narrow.").as_dict(),
        Finding("shift", WARNING, ("extrapolation",), "Shifted.", "Beware.").as_dict(),
    ]
    second = "LEAK: Nearly copied. Too narrow."
    assert leak_notes({"findings": findings}) == {
        "test": f"LEAK: Copied. Training error. {second}",
        "validation": second,
    }
    assert leak_notes({"findings": []}) == {}


def test_neighbours_in_time_are_noted_and_no_leak() -> None:
    finding = {"code": NEIGHBOURS_IN_TIME, "severity": "warning", "subsets": ["test"]}
    card = {"findings": [finding | {"sentence": "optimistic.", "consequence": "See."}]}
    assert leak_notes(card) == {"test": "optimistic. See."}
    assert leaking_subsets(card) == set()
