"""The runs that an ensemble is the weighted mean of; any other run is its own and only member."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from softkin.core.files import read_json
from softkin.core.runs import Run
from softkin.core.samples import Array
from softkin.models.estimators.weighted_mean import weighted_sum

#: Members and their weights, which add up to 1.
Weights = Mapping[Run, float]


def as_records(weights: Weights) -> list[dict[str, Any]]:
    """Weights as the record of a fit holds them."""
    return [{"model": run.model, "preset": run.preset, "weight": weight} for run, weight in weights.items()]


def members_of(run: Run, record: str | Path) -> Weights:
    """The members of a run by the `record` (JSON) of its fit."""
    members = read_json(record).get("members")
    if members is None:
        return {run: 1.0}
    return {Run(member["model"], member["preset"]): float(member["weight"]) for member in members}


def members_of_runs(runs: Iterable[Run], records: Mapping[Run, str | Path]) -> dict[Run, Weights]:
    """The members of each of `runs`; `records` are of all runs."""
    return {run: members_of(run, records[run]) for run in runs}


def all_members(weights: Mapping[Run, Weights]) -> list[Run]:
    """The runs that are fitted for these, each once."""
    return list(dict.fromkeys(member for of_run in weights.values() for member in of_run))


def combined(
    predictions: Mapping[tuple[Run, str], Array], weights: Mapping[Run, Weights]
) -> dict[tuple[Run, str], Array]:
    """What each run of `weights` predicts, part by part, by what its members do."""
    places = list(dict.fromkeys(part for _, part in predictions))
    return {
        (run, part): weighted_sum([predictions[member, part] for member in members], list(members.values()))
        for run, members in weights.items()
        for part in places
    }
