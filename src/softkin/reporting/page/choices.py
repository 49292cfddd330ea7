"""Mark what is chosen and what is deployed: runs and interval methods."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.reporting.page.marks import Mark
from softkin.training.selection import deployed

CHOSEN = Mark("chosen", "the lowest typical Winkler score, cross-validated on validation rows")
DEPLOYED = Mark("deployed", "what the calibrated model holds: the chosen run, and the best interval method around it")


@dataclass(frozen=True, slots=True)
class Choices:
    """The deployed `runs` (dataset, model, preset), and the marks of chosen and deployed `intervals` by (dataset,
    subset, model, preset, method): the method may be another in extrapolation.
    """

    runs: frozenset[tuple[str, str, str]]
    intervals: Mapping[tuple[str, str, str, str, str], tuple[Mark, ...]]

    def of_run(self, dataset: str, model: str, preset: str) -> tuple[Mark, ...]:
        """The mark of a deployed run."""
        return (DEPLOYED,) * ((dataset, model, preset) in self.runs)

    def of_interval(self, dataset: str, subset: str, model: str, preset: str, method: str) -> tuple[Mark, ...]:
        """The marks of an interval method around a run on a subset."""
        return self.intervals.get((dataset, subset, model, preset, method), ())


def read_choices(frames: Mapping[str, pd.DataFrame]) -> Choices:
    """Read interval_choice and, where runs were searched, selection."""
    choice = frames["interval_choice"]
    runs = deployed(frames["selection"]) if "selection" in frames else choice[choice["deployed"]]
    intervals = {
        (row.dataset, subset, row.model, row.preset, method): marks_of_candidate(row.chosen, row.deployed)
        for row in choice[choice["chosen"] | choice["deployed"]].itertuples()
        for subset, method in ((TEST, row.interval_method), (EXTRAPOLATION, row.outside))
    }
    return Choices(frozenset(runs[["dataset", "model", "preset"]].itertuples(index=False, name=None)), intervals)


def marks_of_candidate(is_chosen: bool, is_deployed: bool) -> tuple[Mark, ...]:
    """The marks of a row of interval_choice."""
    return (CHOSEN,) * bool(is_chosen) + (DEPLOYED,) * bool(is_deployed)
