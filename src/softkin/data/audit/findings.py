"""What an audit says of a dataset: findings, each with its rows and what follows from it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import EXTRAPOLATION, TEST, VALIDATION

#: From mild to grave. A leak marks every testing table of its dataset; a warning is for whoever fits; a note is told.
NOTE, WARNING, LEAK = SEVERITIES = ("note", "warning", "leak")

#: What follows for each subset whose commands stand in train.
LEAK_CONSEQUENCES = {
    VALIDATION: "Intervals are calibrated on commands that the model was fitted to: too narrow for new ones.",
    TEST: "The score on these rows is training error: it says how well a model remembers, not how well it predicts.",
    EXTRAPOLATION: "The score on these rows is training error and says nothing about extrapolation.",
}

#: A finding lists at most this many rows of a subset; it always counts all.
MAX_ROWS_LISTED = 100


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that a reader of the dataset's tables must know.

    `rows` holds the first `MAX_ROWS_LISTED` row numbers (0-based, within the subset) of each subset in `subsets`, and
    `n_rows` how many there are in all; both are empty where the finding is about columns or a whole subset.
    """

    code: str
    severity: str
    subsets: tuple[str, ...]
    sentence: str
    consequence: str
    rows: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    n_rows: Mapping[str, int] = field(default_factory=dict)

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


@dataclass(frozen=True, slots=True)
class CheckResult:
    """What one check found, and what it measured on the way: plain `numbers` for JSON, found something or not."""

    findings: tuple[Finding, ...]
    numbers: Mapping[str, Any]


def finding_of_rows(
    code: str, severity: str, marked: Mapping[str, NDArray[np.bool_]], sentence: str, consequence: str
) -> Finding:
    """A finding about the rows where `marked` (subset -> mask (n_rows,)) is True; subsets without any are left out."""
    rows = {subset: np.flatnonzero(mask) for subset, mask in marked.items() if mask.any()}
    return Finding(
        code,
        severity,
        tuple(rows),
        sentence,
        consequence,
        {subset: tuple(numbers[:MAX_ROWS_LISTED].tolist()) for subset, numbers in rows.items()},
        {subset: len(numbers) for subset, numbers in rows.items()},
    )


def counted(number: int, noun: str) -> str:
    """'1 row', '2 rows'."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def leaking_subsets(card: Mapping[str, Any]) -> set[str]:
    """The subsets whose scores are training error, by a data card."""
    return {subset for finding in card["findings"] if finding["severity"] == LEAK for subset in finding["subsets"]}


def leak_notes(card: Mapping[str, Any]) -> dict[str, str]:
    """What a reader of a subset's scores must know of its leaks, by subset and by a data card."""
    notes: dict[str, str] = {}
    for finding in card["findings"]:
        for subset in finding["subsets"] if finding["severity"] == LEAK else ():
            note = f"LEAK: {finding['sentence']} {finding['consequence']}"
            notes[subset] = f"{notes.get(subset, '')} {note}".strip()
    return notes


def worst_severity(findings: Sequence[Finding]) -> str | None:
    """The gravest severity among `findings`, or None."""
    return max((finding.severity for finding in findings), key=SEVERITIES.index, default=None)
