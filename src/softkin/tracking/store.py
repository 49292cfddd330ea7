"""Open the MLflow store, and log each run to it once.

The tag `softkin.key` identifies a run. It is replaced only when `softkin.content`, a hash over what the run shows
(timings apart), has changed. So logging twice changes nothing.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
import sqlite3
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

os.environ.setdefault("MLFLOW_DISABLE_TELEMETRY", "true")
os.environ.setdefault("MLFLOW_ENABLE_ARTIFACTS_PROGRESS_BAR", "false")

from filelock import FileLock
from mlflow import MlflowClient
from mlflow.entities import DatasetInput, Metric, Param, Run

from softkin.core.errors import StoreError
from softkin.core.files import read_json
from softkin.data.audit.findings import LEAK

logger = logging.getLogger("softkin")

KEY, CONTENT, PARENT, NOTE = "softkin.key", "softkin.content", "mlflow.parentRunId", "mlflow.note.content"
SQLITE = "sqlite:///"
#: The store takes a thousand metrics a batch.
BATCH = 900
#: Entries that the store gives at once.
PAGE = 1000


@dataclass(frozen=True, slots=True)
class Campaign:
    """One complete run of the workflow on one configuration: name, seed, where its store and artifacts are, and what it
    says of its own numbers.
    """

    name: str
    seed: int
    tracking_uri: str
    artifacts: str
    caution: str | None = None
    #: Milliseconds. The UI sorts runs by their start, newest first.
    started: int = field(default_factory=lambda: int(time.time() * 1000))


@dataclass(frozen=True, slots=True)
class Record:
    """What one run shows. It is a new run when its `content` changes; `texts` and `files` become artifacts, `figures`
    artifacts in a folder of that name. `started` (milliseconds) and `seconds` place it in the UI's table.
    """

    key: str
    name: str
    content: Any
    tags: Mapping[str, str]
    started: int
    seconds: float = 0.0
    metrics: Mapping[str, float] = field(default_factory=dict)
    curves: Sequence[tuple[str, int, float]] = ()
    params: Mapping[str, Any] = field(default_factory=dict)
    inputs: Sequence[DatasetInput] = ()
    files: Sequence[str] = ()
    figures: Sequence[str] = ()
    texts: Mapping[str, str] = field(default_factory=dict)


def read_description(description: str | Path, data_card: str | Path) -> dict[str, Any]:
    """A dataset's description (JSON) with the `findings` of its data card (JSON)."""
    return {**read_json(description), "findings": read_json(data_card)["findings"]}


def common_tags(campaign: Campaign, description: Mapping[str, Any]) -> dict[str, str]:
    """The tags of every run, from a dataset's `description` as `read_description` returns it."""
    return {
        "campaign": campaign.name,
        "dataset": description["dataset"],
        "data_sha256": description["sha256"],
        "origin": description["origin"],
        "seed": str(campaign.seed),
        "leak": str(any(finding["severity"] == LEAK for finding in description["findings"])).lower(),
    }


def caution_note(campaign: Campaign) -> str:
    """The end of each description in MLflow: what the configuration says of its own numbers, if anything."""
    return f"\n\n**caution**: {campaign.caution}" if campaign.caution else ""


def caution_content(campaign: Campaign) -> dict[str, str]:
    """The same as a part of a record's content: runs without a caution keep the content that they had."""
    return {"caution": campaign.caution} if campaign.caution else {}


def create_store(tracking_uri: str) -> None:
    """Create the MLflow store if there is none. One job does this before any other opens it: first use is a race."""
    if tracking_uri.startswith(SQLITE):
        file = Path(tracking_uri.removeprefix(SQLITE)).resolve()
        with FileLock(f"{file}.lock"):
            MlflowClient(tracking_uri).search_experiments(max_results=1)
            connection = sqlite3.connect(file)
            connection.execute("PRAGMA journal_mode=WAL")
            connection.close()
    else:
        MlflowClient(tracking_uri).search_experiments(max_results=1)
    logger.info("the MLflow store is %s", tracking_uri)


def client_of(tracking_uri: str) -> MlflowClient:
    """An MLflow client of a store that exists.

    Raises:
        StoreError: the store is gone.
    """
    if tracking_uri.startswith(SQLITE) and not Path(tracking_uri.removeprefix(SQLITE)).exists():
        raise StoreError("the MLflow store is gone", where=tracking_uri, fix="make it again from results/: make store")
    return MlflowClient(tracking_uri)


def experiment_of(client: MlflowClient, dataset: str, artifacts: str) -> str:
    """Id of the dataset's experiment; created, or restored, when it is not there."""
    experiment = client.get_experiment_by_name(dataset)
    if experiment is not None and experiment.lifecycle_stage == "deleted":
        client.restore_experiment(experiment.experiment_id)
    if experiment is not None:
        return str(experiment.experiment_id)
    # A tracking server has its own place for artifacts.
    is_file = client.tracking_uri.startswith(SQLITE)
    location = (Path(artifacts) / dataset).resolve().as_uri() if is_file else None
    return str(client.create_experiment(dataset, artifact_location=location))


def put(client: MlflowClient, experiment: str, record: Record, there: Sequence[Run] | None = None) -> str:
    """Log `record` unless a run of the same content is there; return the id of the run. Runs of other content go.

    `there` are runs among which those of the record's key are; None: they are looked up.
    """
    content = hashlib.sha256(json.dumps(record.content, sort_keys=True).encode()).hexdigest()
    there = find(client, experiment, **{KEY: record.key}) if there is None else there
    old = [run for run in there if run.data.tags.get(KEY) == record.key]
    current = [run for run in old if run.data.tags.get(CONTENT) == content and run.info.status == "FINISHED"]
    if current:
        delete(client, [run for run in old if run is not current[0]])
        run_id = str(current[0].info.run_id)
        # The parent is no part of the content.
        if PARENT in record.tags and current[0].data.tags.get(PARENT) != record.tags[PARENT]:
            client.set_tag(run_id, PARENT, record.tags[PARENT])
        return run_id
    tags = {KEY: record.key, **record.tags}
    run_id = str(client.create_run(experiment, record.started, tags, record.name).info.run_id)
    now = int(time.time() * 1000)
    metrics = [Metric(name, value, now, 0) for name, value in record.metrics.items()]
    metrics += [Metric(name, value, now, step) for name, step, value in record.curves]
    params = [Param(name, str(value)) for name, value in record.params.items()]
    for start in range(0, max(len(metrics), 1), BATCH):
        client.log_batch(run_id, metrics=metrics[start : start + BATCH], params=params if start == 0 else ())
    if record.inputs:
        client.log_inputs(run_id, list(record.inputs))
    for file in record.files:
        client.log_artifact(run_id, file)
    for file in record.figures:
        client.log_artifact(run_id, file, "figures")
    for name, text in record.texts.items():
        client.log_text(run_id, text, name)
    # The content tag comes last: a run that was cut off has none, and is logged again.
    client.set_tag(run_id, CONTENT, content)
    client.set_terminated(run_id, end_time=record.started + int(1000 * record.seconds))
    delete(client, old)
    return run_id


def find(client: MlflowClient, experiment: str, **tags: str) -> list[Run]:
    """The experiment's runs with these tags, however many there are."""
    query = " and ".join(f"tags.`{name}` = '{value}'" for name, value in tags.items())
    return list(all_pages(client.search_runs, [experiment], query))


def all_pages(search: Callable[..., Any], *wanted: Any) -> Iterator[Any]:
    """All that a `search_...` of MLflow's client finds by the arguments `wanted`: it gives a page at a time."""
    token = None
    while True:
        page = search(*wanted, max_results=PAGE, page_token=token)
        yield from page
        token = page.token
        if not token:
            return


def delete(client: MlflowClient, runs: Sequence[Run]) -> None:
    """Mark runs as deleted."""
    for run in runs:
        client.delete_run(run.info.run_id)
