"""Remove old campaigns from a store, and the runs that were superseded before the oldest one that is kept."""

from __future__ import annotations

from dataclasses import dataclass

from mlflow import MlflowClient
from mlflow.entities import Run

from softkin.tracking.nights import EXPERIMENT, JUDGED_IN, nights
from softkin.tracking.promotion import aliases_of
from softkin.tracking.records import CURRENT, NO, SUPERSEDED_AT, all_pages, find

PREFIX = "softkin-"


@dataclass(frozen=True, slots=True)
class Removal:
    """What goes: campaigns, runs of models and intervals, and (name, version) of registered models."""

    campaigns: list[Run]
    runs: list[Run]
    versions: list[tuple[str, str]]

    def sentences(self) -> list[str]:
        """What goes, in words."""
        named = [f"campaign {run.info.run_name} ({run.info.run_id})" for run in self.campaigns]
        named += [f"version {version} of {name}" for name, version in self.versions]
        return [*named, f"{len(self.runs)} superseded runs"]


def to_remove(client: MlflowClient, keep: int) -> Removal:
    """What is older than the `keep` last campaigns and nothing refers to.

    Kept whatever their age: current runs, versions with an alias and their runs, and campaigns that these were judged
    in.
    """
    everything = nights(client)
    if len(everything) <= keep:
        return Removal([], [], [])
    oldest = min(run.info.start_time for run in everything[:keep]) if keep else float("inf")
    held, judged, versions = _versions(client, oldest)
    campaigns = [run for run in everything[keep:] if run.info.run_id not in judged]
    runs = []
    for experiment in client.search_experiments():
        if experiment.name != EXPERIMENT:
            old = find(client, experiment.experiment_id, **{CURRENT: NO})
            runs += [run for run in old if _superseded_at(run) < oldest and run.info.run_id not in held]
    return Removal(campaigns, runs, versions)


def _superseded_at(run: Run) -> float:
    """When a run was superseded, in milliseconds; that of a run that is being written is in the future."""
    return float(run.data.tags.get(SUPERSEDED_AT, "inf"))


def remove(client: MlflowClient, removal: Removal) -> None:
    """Delete from the store what `to_remove` found."""
    for name, version in removal.versions:
        client.delete_model_version(name, version)
    for run in [*removal.campaigns, *removal.runs]:
        client.delete_run(run.info.run_id)


def _versions(client: MlflowClient, oldest: float) -> tuple[set[str], set[str], list[tuple[str, str]]]:
    """Runs of the versions that stay, campaigns that these were judged in, and the versions that go."""
    held, judged, gone = set(), set(), []
    for model in all_pages(lambda **page: client.search_registered_models(**page)):
        if not model.name.startswith(PREFIX) or not model.aliases:
            continue
        named = set(aliases_of(client, model.name).values())
        for version in all_pages(client.search_model_versions, f"name = '{model.name}'"):
            if str(version.version) in named or version.creation_timestamp >= oldest:
                held.add(version.run_id)
                judged.add(version.tags.get(JUDGED_IN))
            else:
                gone.append((model.name, str(version.version)))
    return held, judged, gone
