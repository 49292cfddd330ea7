"""Findings of an audit: severity, rows, a sentence and its consequence; and what a data card tells of leaks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import EXTRAPOLATION, TEST, VALIDATION

#: From mild to grave. A leak marks the tables of its subset; a warning asks for care; a note touches no score.
NOTE, WARNING, LEAK = SEVERITIES = ("note", "warning", "leak")

#: What follows for each subset whose rows stand in `train`. The tables hold these sentences.
LEAK_CONSEQUENCES = {
    VALIDATION: "Intervals are calibrated on commands that the model was fitted to: too narrow for new ones.",
    TEST: "The score on these rows is training error: it says how well a model remembers, not how well it predicts.",
    EXTRAPOLATION: "The score on these rows is training error and says nothing about extrapolation.",
}

#: Code of the finding that a subset's scores are optimistic, since rows next to its own in time stand in `train`.
NEIGHBOURS_IN_TIME = "neighbours_in_time"

#: A finding lists at most this many rows of a subset; it always counts all.
MAX_ROWS_LISTED = 100


@dataclass(frozen=True, slots=True)
class Finding:
    """One result of a check that a reader of the dataset's tables must know.

    `rows` holds the first `MAX_ROWS_LISTED` row numbers (0-based, within the subset) of each subset in `subsets`, and
    `n_rows` how many there are in all; both are empty where the finding is on columns or a whole subset.
    """

    code: str
    severity: str
    subsets: tuple[str, ...]
    sentence: str
    consequence: str
    rows: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    n_rows: Mapping[str, int] = field(default_factory=dict)

    def as_dict(self) -> dict[str, Any]:
        """The finding as a dictionary for JSON."""
        return asdict(self)


@dataclass(frozen=True, slots=True)
class CheckResult:
    """The findings of one check, and the `numbers` that it measured, for JSON."""

    findings: tuple[Finding, ...]
    numbers: Mapping[str, Any]


def finding_of_rows(
    code: str, severity: str, marked: Mapping[str, NDArray[np.bool_]], sentence: str, consequence: str
) -> Finding:
    """A finding on marked rows; subsets without any are left out.

    Parameters:
        code: short name of the finding.
        severity: one of `SEVERITIES`.
        marked: subset -> mask (n_rows,) of the rows that the finding is on.
        sentence: what is the case.
        consequence: what follows for a reader of the dataset's tables.
    """
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
    """A number with its noun: '1 row', '2 rows'."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def leaking_subsets(card: Mapping[str, Any]) -> set[str]:
    """The subsets that leak, by a data card: their scores are training error."""
    return {subset for finding in card["findings"] if finding["severity"] == LEAK for subset in finding["subsets"]}


def leak_notes(card: Mapping[str, Any]) -> dict[str, str]:
    """Subset -> the note on its leaks, and on neighbours in time that stand in `train`, by a data card."""
    notes: dict[str, str] = {}
    for finding in card["findings"]:
        is_leak, is_optimistic = finding["severity"] == LEAK, finding.get("code") == NEIGHBOURS_IN_TIME
        for subset in finding["subsets"] if is_leak or is_optimistic else ():
            note = f"{'LEAK: ' * is_leak}{finding['sentence']} {finding['consequence']}"
            notes[subset] = f"{notes.get(subset, '')} {note}".strip()
    return notes


def worst_severity(findings: Sequence[Finding]) -> str | None:
    """The gravest severity among `findings`, or None."""
    return max((finding.severity for finding in findings), key=SEVERITIES.index, default=None)
