"""Log each campaign as a run of its own, find the one to compare with, and move champions by its verdict."""

from __future__ import annotations

import json
import logging
import math
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
from mlflow import MlflowClient
from mlflow.entities import Metric
from mlflow.entities import Run as LoggedRun
from mlflow.exceptions import MlflowException

from softkin.core.files import read_json
from softkin.tracking.lock import locked
from softkin.tracking.promotion import CANDIDATE, CHAMPION, aliases_of, promote
from softkin.tracking.records import find, infinite_of, log_points, sweep
from softkin.tracking.saved_view import CAMPAIGNS_TAG, campaigns_view
from softkin.tracking.store import NOTE, experiment_of

logger = logging.getLogger("softkin")

#: The experiment that holds a run for each campaign; the kind of these runs.
EXPERIMENT, KIND = "campaigns", "night"
#: The experiment in which the numbers of all nights are curves.
HISTORY = "history"
SUMMARY, ROWS = "summary.json", "summary_rows.parquet"
#: Tag of the format of a summary.
FORMAT = "summary_format"
#: Tag of a registered version: the campaign whose rows its successor is compared with.
JUDGED_IN = "judged_in"
#: Outcomes of campaigns that have no numbers to compare with.
WITHOUT_NUMBERS = ("failed",)
#: Metrics that the view of nights shows of each dataset.
SHOWN = ("test/euclidean_mean_mm", "extrapolation/euclidean_mean_mm", "test/coverage_90")


@dataclass(frozen=True, slots=True)
class Night:
    """A campaign that was logged: id of its run, its summary, and its rows as `summarise` writes them."""

    run_id: str
    summary: Mapping[str, Any]
    rows: pd.DataFrame


@dataclass(frozen=True, slots=True)
class NightRecord:
    """What is logged of a campaign.

    Parameters:
        verdict: as JSON has it.
        page: the verdict to read, Markdown.
        summary: of the workflow's results, with the versions of its software; None where there are none.
        rows: file of the rows that go with the summary; None where there are no new results.
        files: folder among the artifacts ('' for the top) -> files.
        started: seconds since the epoch.
        same_as: run of the campaign whose results these are; None: they are new.
    """

    verdict: Mapping[str, Any]
    page: str
    summary: Mapping[str, Any] | None
    rows: str | Path | None
    files: Mapping[str, Sequence[str | Path]]
    started: float
    same_as: str | None = None


@dataclass(frozen=True, slots=True)
class Candidate:
    """A version that is not the champion, and what the champion is compared by; None: it was never judged."""

    dataset: str
    name: str
    version: str
    champion: str
    judged_in: str | None


def last_night(client: MlflowClient, summary: Mapping[str, Any]) -> Night | None:
    """The last campaign of the same configuration, else the last one of the same name; None where there is none whose
    summary has the same format.
    """
    experiment = experiment_of(client, EXPERIMENT)
    of_name = {"kind": KIND, "campaign": summary["campaign"], FORMAT: str(summary["format"])}
    for tags in (of_name | {"configuration_sha256": summary["configuration_sha256"]}, of_name):
        nights = find(client, experiment, "attributes.status = 'FINISHED'", **tags)
        with_numbers = [run for run in nights if run.data.tags["verdict"] not in WITHOUT_NUMBERS]
        if with_numbers:
            return night_of(client, max(with_numbers, key=lambda run: run.info.start_time).info.run_id)
    return None


def night_of(client: MlflowClient, run_id: str) -> Night:
    """The campaign that is logged in a run."""
    with tempfile.TemporaryDirectory() as folder:
        files = {name: client.download_artifacts(run_id, name, folder) for name in (SUMMARY, ROWS)}
        return Night(run_id, read_json(files[SUMMARY]), pd.read_parquet(files[ROWS]))


def log_night(client: MlflowClient, record: NightRecord) -> str:
    """Log a campaign as a run of its own; return its id. A run that a killed one left half logged is removed."""
    experiment = experiment_of(client, EXPERIMENT)
    with locked(client.tracking_uri, EXPERIMENT):
        sweep(client, experiment, kind=KIND)
        return _log(client, experiment, record)


def _log(client: MlflowClient, experiment: str, record: NightRecord) -> str:
    summary, verdict = record.summary, record.verdict
    campaign = summary["campaign"] if summary else "unknown"
    name = f"{campaign} · {time.strftime('%Y-%m-%d %H:%M', time.gmtime(record.started))}"
    tags = {"kind": KIND, "campaign": campaign, **_tags(record)}
    run_id = str(client.create_run(experiment, int(1000 * record.started), tags, name).info.run_id)
    now = int(1000 * time.time())
    metrics = [Metric(key, value, now, 0) for key, value in _metrics(verdict, summary).items() if math.isfinite(value)]
    log_points(client, run_id, metrics)
    client.log_text(run_id, json.dumps(verdict, indent=2, allow_nan=False), "verdict.json")
    client.log_text(run_id, record.page, "verdict.md")
    if summary and record.rows:
        client.log_text(run_id, json.dumps(summary, indent=2, allow_nan=False), SUMMARY)
        client.log_artifact(run_id, str(record.rows))
    for folder, paths in record.files.items():
        for path in paths:
            client.log_artifact(run_id, str(path), folder or None)
    if summary:
        columns = [f"metrics.`{dataset}/{metric}`" for metric in SHOWN for dataset in summary["datasets"]]
        view = campaigns_view(["tags.`verdict`", "metrics.`duration_seconds`", "metrics.`jobs_run`", *columns])
        client.set_experiment_tag(experiment, CAMPAIGNS_TAG, view)
    client.set_experiment_tag(experiment, NOTE, "A run for each campaign. *Views*, at the top right, has *Nights*.")
    if summary:
        _go_on_with_history(client, campaign, metrics)
    # Its end comes last: a night that was cut off is still running, and is swept by the next one.
    client.set_terminated(run_id, "FINISHED" if verdict["outcome"] not in WITHOUT_NUMBERS else "FAILED")
    return run_id


def _go_on_with_history(client: MlflowClient, campaign: str, metrics: Sequence[Metric]) -> None:
    """Log the numbers of a campaign as the next step of one run, in which a year of nights is a curve."""
    experiment = experiment_of(client, HISTORY)
    client.set_experiment_tag(experiment, NOTE, "A run for each name of a campaign; a step of its metrics is a night.")
    found = find(client, experiment, kind=HISTORY, campaign=campaign)
    tags = {"kind": HISTORY, "campaign": campaign}
    run = found[0] if found else client.create_run(experiment, tags=tags, run_name=f"{campaign} · nights")
    step = int(run.data.metrics.get("night", 0)) + 1
    points = [Metric(one.key, one.value, one.timestamp, step) for one in metrics]
    points.append(Metric("night", step, points[0].timestamp, step))
    log_points(client, run.info.run_id, points)
    client.set_terminated(run.info.run_id)


def candidates(client: MlflowClient, datasets: Sequence[str]) -> list[Candidate]:
    """The newest versions of datasets that are not their champions."""
    found = []
    for dataset in datasets:
        name = f"softkin-{dataset}"
        try:
            aliases = aliases_of(client, name)
        except MlflowException as error:
            if error.error_code != "RESOURCE_DOES_NOT_EXIST":
                raise
            continue
        champion, candidate = aliases.get(CHAMPION), aliases.get(CANDIDATE)
        if champion is None or candidate in (None, champion):
            continue
        tags = client.get_model_version(name, champion).tags
        found.append(Candidate(dataset, name, candidate, champion, tags.get(JUDGED_IN)))
    return found


def move_champions(client: MlflowClient, moved: Mapping[Candidate, str], datasets: Sequence[str], run_id: str) -> None:
    """Make candidates champions, each for a reason; and note on every champion that this campaign has judged it.

    Parameters:
        client: of the store.
        moved: candidate -> why it is champion now.
        datasets: all datasets of the campaign.
        run_id: of the campaign.
    """
    for candidate, reason in moved.items():
        promote(client, candidate.name, candidate.version, reason)
        client.set_model_version_tag(candidate.name, candidate.version, JUDGED_IN, run_id)
    waiting = {one.dataset for one in candidates(client, datasets)}
    for dataset in datasets:
        name = f"softkin-{dataset}"
        if dataset not in waiting:
            version = aliases_of(client, name)[CHAMPION]
            if JUDGED_IN not in client.get_model_version(name, version).tags:
                client.set_model_version_tag(name, version, JUDGED_IN, run_id)


def nights(client: MlflowClient) -> list[LoggedRun]:
    """All campaigns, the last first."""
    runs = find(client, experiment_of(client, EXPERIMENT), kind=KIND)
    return sorted(runs, key=lambda run: run.info.start_time, reverse=True)


def _tags(record: NightRecord) -> dict[str, str]:
    """What the run of a campaign says of itself in words."""
    verdict, summary = record.verdict, record.summary
    known = ("commit", "jobs_run", "jobs_reused", "promoted")
    tags = {name: str(verdict[name]) for name in known if verdict.get(name) is not None}
    tags |= {"verdict": verdict["outcome"], NOTE: record.page, **infinite_of(_metrics(verdict, summary))}
    if summary:
        tags |= {"configuration_sha256": summary["configuration_sha256"], FORMAT: str(summary["format"])}
        tags |= {"environment_sha256": summary["software_sha256"]}
        for name, data in summary["datasets"].items():
            tags |= {f"data_sha256.{name}": data["sha256"], f"deployed.{name}": _deployed(data["deployed"])}
    return tags | ({"same_results_as": record.same_as} if record.same_as else {})


def _deployed(run: Mapping[str, str]) -> str:
    return f"{run['model']} {run['preset']} {run['interval_method']}"


def _metrics(verdict: Mapping[str, Any], summary: Mapping[str, Any] | None) -> dict[str, float]:
    """finger/test/rmse_mm, ..., and what the campaign took. A summary has null for what is infinite."""
    known = ("duration_seconds", "cpu_seconds", "jobs_run", "jobs_reused", "exit_code")
    values = {name: float(verdict[name]) for name in known if verdict.get(name) is not None}
    for dataset, data in (summary["datasets"] if summary else {}).items():
        of_dataset = data["metrics"].items()
        values |= {f"{dataset}/{name}": math.inf if value is None else float(value) for name, value in of_dataset}
    return values
