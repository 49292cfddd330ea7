"""What a reader must know of a number before believing it: leaks, rows left out, stand-ins."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from softkin.core.samples import SUBSETS, VALIDATION


@dataclass(frozen=True, slots=True)
class Mark:
    """A badge: `kind` is its word and its look, `text` what it means (empty where the word says it all)."""

    kind: str
    text: str = ""


CHOSEN = Mark("chosen")
CUT = "rows were left out (max_rows_per_subset): not comparable with the paper, nor with a complete run"
STANDIN = "a stand-in, simulated by softkin in place of the published data: its numbers say nothing of the real robot"


class Marks:
    """The marks of every dataset and subset.

    `notes` of an entry in config/datasets.yaml become a `caution` on that subset; a finding of severity `leak` in a
    data card a `leak`; `is_cut` and `standin` of dataset.json mark every subset.
    """

    def __init__(
        self,
        sources: Mapping[str, Mapping[str, Any]],
        descriptions: Mapping[str, Mapping[str, Any]],
        cards: Mapping[str, Mapping[str, Any]],
    ) -> None:
        self._marks: dict[tuple[str, str], list[Mark]] = {}
        for dataset, about in descriptions.items():
            notes = sources[dataset].get("notes", {})
            findings = [f for f in cards.get(dataset, {}).get("findings", []) if f["severity"] == "leak"]
            for subset in SUBSETS:
                leaks = [f["sentence"] + " " + f["consequence"] for f in findings if subset in f["subsets"]]
                texts = {
                    "leak": " ".join([*leaks, *([notes[subset]] if leaks and subset in notes else [])]),
                    "caution": notes.get(subset, "") if not leaks else "",
                }
                place = f"{dataset}, {subset}: "
                marks = [Mark(kind, place + text.strip()) for kind, text in texts.items() if text]
                marks += [Mark("rows left out", f"{dataset}: {CUT}.")] * bool(about["is_cut"])
                marks += [Mark("stand-in", f"{dataset}: {STANDIN}.")] * (about.get("origin") == "stand-in")
                self._marks[dataset, subset] = marks

    def of(self, dataset: str, subset: str) -> tuple[Mark, ...]:
        """The marks of a number that was measured on `subset`."""
        return tuple(self._marks[dataset, subset])

    def of_interval(self, dataset: str, subset: str) -> tuple[Mark, ...]:
        """The marks of an interval's score on `subset`: those of `validation`, which calibrated it, as well."""
        return merged([self.of(dataset, subset), self.of(dataset, VALIDATION)])

    def of_dataset(self, dataset: str) -> tuple[Mark, ...]:
        """Every mark of a dataset."""
        return merged([self.of(dataset, subset) for subset in SUBSETS])


def merged(groups: Sequence[Sequence[Mark]]) -> tuple[Mark, ...]:
    """Each mark once, in the order of its first appearance."""
    return tuple(dict.fromkeys(mark for group in groups for mark in group))


def kinds(marks: Sequence[Mark]) -> list[str]:
    """The words of some marks, each once."""
    return list(dict.fromkeys(mark.kind for mark in marks))
