from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import pytest

from softkin.campaigns.changes import changes_between

DATA = {
    "sha256": "ab",
    "content_sha256": {"train": "a"},
    "rows": {"train": 90, "test": 10},
    "n_commands": 2,
    "n_markers": 1,
    "constant_coordinates": [],
    "unit_in_file": "mm",
    "origin": "published",
    "findings": [],
    "deployed": {"model": "gp", "preset": "tuned", "interval_method": "auto"},
}
SUMMARY: dict[str, Any] = {
    "datasets": {"finger": DATA},
    "configuration": {"seed": 0, "tuning": {"n_trials": 5}},
    "software": {"numpy": "2.4"},
}
FINDING = {"code": "gross", "severity": "warning", "sentence": "Two rows are far off."}


def put(path: str, value: Any) -> Callable[[dict[str, Any]], None]:
    *way, last = path.split("/")

    def change(summary: dict[str, Any]) -> None:
        inner = summary
        for key in way:
            inner = inner[key]
        inner[last] = value

    return change


@pytest.mark.parametrize(
    ("change", "says", "person"),
    [
        (put("datasets/finger/n_commands", 3), "finger: the number of commands is 3, before 2.", True),
        (put("datasets/finger/origin", "stand-in"), "finger: the origin is stand-in, before published.", True),
        (put("datasets/finger/constant_coordinates", ["m1_z"]), "that do not move is ['m1_z'], before none", True),
        (put("datasets/finger/findings", [FINDING]), "finger: new finding (warning): Two rows are far off.", True),
        (put("datasets/finger/content_sha256", {"train": "b"}), "finger has other rows: train 90, test 10.", False),
        (put("datasets/finger/sha256", "cd"), "finger comes from another file with the same rows.", False),
        (put("datasets/arm", DATA), "arm is new.", False),
        (put("datasets", {}), "finger is gone.", False),
        (put("datasets/finger/deployed", {"model": "lr", "preset": "paper", "interval_method": "cps"}),
         "finger: deployed is lr (paper) with cps, before gp (tuned) with auto.", False),
        (put("configuration/tuning/n_trials", 9), "The configuration has tuning.n_trials: 9, before 5.", False),
        (put("configuration/caution", "Few trials."), "has caution: Few trials., before none.", False),
        (put("software/numpy", "2.5"), "numpy is 2.5, before 2.4.", False),
    ],
)  # fmt: skip
def test_what_changed_is_a_sentence(change: Callable[[dict[str, Any]], None], says: str, person: bool) -> None:
    now = copy.deepcopy(SUMMARY)
    change(now)
    found = changes_between(SUMMARY, now)
    assert says in " ".join(found.for_a_person if person else found.sentences)
    assert not (found.sentences if person else found.for_a_person)


def test_nothing_changed_is_no_sentence() -> None:
    found = changes_between(SUMMARY, copy.deepcopy(SUMMARY))
    assert (found.sentences, found.for_a_person) == ([], [])


def test_a_note_and_a_finding_that_was_there_wake_nobody() -> None:
    before, now = copy.deepcopy(SUMMARY), copy.deepcopy(SUMMARY)
    before["datasets"]["finger"]["findings"] = [FINDING]
    now["datasets"]["finger"]["findings"] = [FINDING | {"sentence": "Three rows are."}, FINDING | {"severity": "note"}]
    assert changes_between(before, now).for_a_person == []


def test_a_count_of_rows_that_changed_has_both_numbers() -> None:
    now = copy.deepcopy(SUMMARY)
    now["datasets"]["finger"] |= {"content_sha256": {"train": "b"}, "rows": {"train": 95, "test": 10}}
    assert changes_between(SUMMARY, now).sentences == ["finger has other rows: train 95 (before 90), test 10."]
