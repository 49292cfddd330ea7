"""Mark the numbers that need a warning: leaks, rows left out, stand-ins."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from softkin.core.fit_rows import bounds_of
from softkin.core.narrowing import narrowed
from softkin.core.samples import SUBSETS, TRAIN, VALIDATION
from softkin.core.units import MM, heading, unit_of
from softkin.data.audit.findings import LEAK, NEIGHBOURS_IN_TIME
from softkin.data.scored_rows import DRAWN_FROM


@dataclass(frozen=True, slots=True)
class Mark:
    """A badge: `kind` is its word and its look, `text` what it means (empty where the word says it all)."""

    kind: str
    text: str = ""


CUT = "rows were left out (max_rows_per_subset): not comparable with the paper, nor with a complete run"
FEWER = "of {n_train} rows of train, models are fitted on some, drawn at random (max_fit_rows): {models}"
DRAWN = "{left} of {count} rows of {subset} are kept, drawn at random (max_scored_rows)"
OWN_UNIT = "positions, errors and widths of this robot are in {unit}, also below names that end in _mm"
STANDIN = "a stand-in, simulated by softkin in place of the published data: its numbers say nothing of the real robot"


class Marks:
    """The marks of every dataset and subset.

    A finding of severity `leak` in a data card marks its subsets as a `leak`, one of neighbours in time that stand in
    `train` as `optimistic`; `notes` of an entry in
    config/datasets.yaml stand with it, or are a `caution` on their subset; `is_cut` and the origin of dataset.json mark
    every subset; so do `max_fit_rows`, by dataset the rows that its models are fitted on at most, where `train` has
    more, and a unit that is not mm.
    """

    def __init__(
        self,
        sources: Mapping[str, Mapping[str, Any]],
        descriptions: Mapping[str, Mapping[str, Any]],
        cards: Mapping[str, Mapping[str, Any]],
        max_fit_rows: Mapping[str, Mapping[str, int]] = MappingProxyType({}),
    ) -> None:
        self._marks: dict[tuple[str, str], list[Mark]] = {}
        for dataset, description in descriptions.items():
            notes = sources[dataset].get("notes", {})
            findings = [finding for finding in cards[dataset]["findings"] if finding["severity"] == LEAK]
            for subset in SUBSETS:
                leaks = [f"{f['sentence']} {f['consequence']}" for f in findings if subset in f["subsets"]]
                text = " ".join([*leaks, notes.get(subset, "")]).strip()
                kind = "leak" if leaks else "caution"
                marks = [Mark(kind, f"{dataset}, {subset}: {text}")] * bool(text)
                marks += [
                    Mark("optimistic", f"{dataset}, {subset}: {f['sentence']} {f['consequence']}")
                    for f in cards[dataset]["findings"]
                    if f.get("code") == NEIGHBOURS_IN_TIME and subset in f["subsets"]
                ]
                marks += [Mark("rows left out", f"{dataset}: {CUT}.")] * bool(description["is_cut"])
                fewer = fitted_on_fewer(description, max_fit_rows.get(dataset, {}))
                marks += [Mark("fitted on fewer rows", f"{dataset}: {fewer}.")] * bool(fewer)
                if count := description.get(DRAWN_FROM, {}).get(subset):
                    drawn = DRAWN.format(left=description["rows"][subset], count=count, subset=subset)
                    marks.append(Mark("some of its rows", f"{dataset}: {drawn}."))
                marks += [Mark("stand-in", f"{dataset}: {STANDIN}.")] * (description.get("origin") == "stand-in")
                unit = unit_of(description)
                marks += [Mark(f"in {unit}", f"{dataset}: {OWN_UNIT.format(unit=unit)}.")] * (unit != MM)
                self._marks[dataset, subset] = marks
        self.units = {dataset: unit_of(description) for dataset, description in descriptions.items()}
        #: What heads columns of lengths: 'mm', or all units of the datasets.
        self.unit = heading(self.units.values())

    def of(self, dataset: str, subset: str) -> tuple[Mark, ...]:
        """The marks of a number that was measured on `subset`."""
        return tuple(self._marks[dataset, subset])

    def of_interval(self, dataset: str, subset: str) -> tuple[Mark, ...]:
        """The marks of an interval's score on `subset`: those of `validation`, which calibrated it, as well."""
        return merged([self.of(dataset, subset), self.of(dataset, VALIDATION)])

    def of_dataset(self, dataset: str) -> tuple[Mark, ...]:
        """Every mark of a dataset."""
        return merged([self.of(dataset, subset) for subset in SUBSETS])


def bounds_of_fits(config: Mapping[str, Any], dataset: str) -> dict[str, int]:
    """Of the models and quantile regressors of a dataset, the rows that they are fitted on at most."""
    models, quantile_models = (narrowed(config, key, dataset) for key in ("models", "quantile_models"))
    return bounds_of(config["max_fit_rows"], models, quantile_models)


def fitted_on_fewer(description: Mapping[str, Any], max_fit_rows: Mapping[str, int]) -> str:
    """Which models are fitted on fewer rows than `train` has, and on how many; empty where there are none."""
    if not max_fit_rows:
        return ""
    n_train = description["rows"][TRAIN]
    models = [f"{name} ({most})" for name, most in max_fit_rows.items() if most < n_train]
    return FEWER.format(n_train=n_train, models=", ".join(models)) if models else ""


def merged(groups: Sequence[Sequence[Mark]]) -> tuple[Mark, ...]:
    """Each mark once, in the order of its first appearance."""
    return tuple(dict.fromkeys(mark for group in groups for mark in group))


def kinds(marks: Sequence[Mark]) -> list[str]:
    """The words of some marks, each once."""
    return list(dict.fromkeys(mark.kind for mark in marks))
