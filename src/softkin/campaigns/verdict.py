"""Judge a campaign: how a night ended, why, and with which exit code."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from softkin.campaigns.changes import Changes
from softkin.campaigns.comparison import BETTER, COVERAGE, WORSE, Comparison
from softkin.reporting.tables.numbers import number_text, share_text

#: How a night ends.
FIRST, UNCHANGED, SAME_RESULTS, IMPROVED, GOT_WORSE, DATA_CHANGED, FAILED, UNFINISHED, BUSY = (
    "first", "unchanged", "same", "better", "worse", "data_changed", "failed", "unfinished", "busy",
)  # fmt: skip
#: Exit codes: 0 nothing to do for a person; 75 is EX_TEMPFAIL of sysexits.h.
EXIT_CODES = {
    **dict.fromkeys((FIRST, UNCHANGED, SAME_RESULTS, IMPROVED), 0),
    **dict.fromkeys((FAILED, UNFINISHED), 1),
    GOT_WORSE: 3,
    DATA_CHANGED: 4,
    BUSY: 75,
}
HEADINGS = {
    FIRST: "First campaign: there is nothing to compare it with",
    UNCHANGED: "Nothing changed, and nothing was computed",
    SAME_RESULTS: "Results are the same within their tolerances",
    IMPROVED: "Something got better, and nothing worse",
    GOT_WORSE: "Something got worse",
    DATA_CHANGED: "The data changed in a way that a person must look at",
    FAILED: "The campaign failed",
    UNFINISHED: "The campaign goes on, or was killed",
}


@dataclass(frozen=True, slots=True)
class Verdict:
    """How a campaign ended. `reasons` are sentences, the gravest first; `facts` are what else is known of it."""

    outcome: str
    reasons: Sequence[str] = ()
    changes: Sequence[str] = ()
    comparisons: Sequence[Comparison] = ()
    facts: Mapping[str, Any] = field(default_factory=dict)

    @property
    def exit_code(self) -> int:
        """0 same or better, 1 failed, 3 worse, 4 data that need a person."""
        return EXIT_CODES[self.outcome]

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "outcome": self.outcome,
            "exit_code": self.exit_code,
            "heading": HEADINGS[self.outcome],
            "reasons": list(self.reasons),
            "changes": list(self.changes),
            **self.facts,
            "comparisons": [one.as_dict() for one in self.comparisons],
        }

    def as_markdown(self) -> str:
        """A page to read, and the text of a notification."""
        lines = [f"# {HEADINGS[self.outcome]}", ""]
        lines += [f"- {reason}" for reason in self.reasons] + [""] * bool(self.reasons)
        if self.changes:
            lines += ["## What changed", "", *(f"- {sentence}" for sentence in self.changes), ""]
        if self.facts:
            lines += ["## The campaign", "", "| | |", "| --- | --- |"]
            lines += [f"| {name.replace('_', ' ')} | {_cell(value)} |" for name, value in self.facts.items()] + [""]
        if self.comparisons:
            lines += ["## Now and before", "", "| dataset | subset | number | before | now | | p |"]
            lines += ["| --- | --- | --- | --- | --- | --- | --- |", *map(_row, self.comparisons), ""]
            lines += ["p: chance of a difference as large where nothing changed, corrected for all rows of the table."]
        return "\n".join(lines).rstrip() + "\n"


def judge(
    comparisons: Sequence[Comparison], changes: Changes, *, jobs_run: int | None, facts: Mapping[str, Any]
) -> Verdict:
    """The verdict on a campaign that ended well and has one to compare with.

    Parameters:
        comparisons: of its numbers with those before.
        changes: of data, configuration and software.
        jobs_run: how many jobs the workflow ran.
        facts: what else is known of the campaign.
    """
    worse, better = ([one for one in comparisons if one.outcome == outcome] for outcome in (WORSE, BETTER))
    reasons = [*changes.for_a_person, *map(sentence, worse), *map(sentence, better)]
    if changes.for_a_person:
        outcome = DATA_CHANGED
    elif worse:
        outcome = GOT_WORSE
    elif better:
        outcome = IMPROVED
    else:
        outcome = UNCHANGED if jobs_run == 0 else SAME_RESULTS
    return Verdict(outcome, reasons, changes.sentences, comparisons, facts)


def sentence(one: Comparison) -> str:
    """What a comparison says."""
    before, now = (_number(one, value) for value in (one.before, one.now))
    p = min(one.p_worse, one.p_better)
    return f"{one.dataset}, {one.subset}: the {one.title} is {now}, before {before} (p = {p:.2g})."


def _number(one: Comparison, value: float) -> str:
    return share_text(value) if one.metric == COVERAGE else number_text(value)


def _row(one: Comparison) -> str:
    before, now = (_number(one, value) for value in (one.before, one.now))
    p = f"{min(one.p_worse, one.p_better):.2g}"
    return f"| {one.dataset} | {one.subset} | {one.title} | {before} | {now} | {one.outcome} | {p} |"


def _cell(value: Any) -> str:
    return "unknown" if value is None else str(value).replace("|", "\\|")
