"""Log each run to the MLflow store once, and keep the runs that it follows.

The tag `softkin.key` identifies what a run shows. A run is followed by a new one only when its `softkin.content`, a
hash over what it shows (timings apart), has changed; so logging twice changes nothing. Of the runs of a key one has the
tag `current` = true; the others have `superseded_by`, the id of the run after them, and that one has `supersedes`.
"""

from __future__ import annotations

import hashlib
import json
import logging
import math
import tempfile
import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mlflow import MlflowClient
from mlflow.entities import DatasetInput, Metric, Param, Run, RunTag
from mlflow.store.artifact.artifact_repository_registry import get_artifact_repository

from softkin.tracking.artifacts import are_there
from softkin.tracking.store import PARENT

logger = logging.getLogger("softkin")

KEY, CONTENT = "softkin.key", "softkin.content"
CURRENT, SUPERSEDES, SUPERSEDED_BY = "current", "supersedes", "superseded_by"
#: When a run was superseded, in milliseconds since the epoch.
SUPERSEDED_AT = "superseded_at"
#: The value of `superseded_by` where the configuration has no such run any more.
NOTHING = "nothing"
YES, NO = "true", "false"
#: Tag that names the metrics that are infinite, for example the width of an interval whose level cannot be had.
INFINITE = "infinite"
#: The store takes a thousand metrics a batch.
BATCH = 900
#: Entries that the store gives at once.
PAGE = 1000


@dataclass(frozen=True, slots=True)
class Record:
    """What one run shows. It is a new run when its `content` changes; `texts` and `files` become artifacts, `figures`
    artifacts in a folder of that name. `started` (milliseconds) and `seconds` place it in the UI's table. Of `metrics`
    the finite ones become metrics; the infinite ones are named in a tag.
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

    def artifacts(self) -> tuple[list[str], list[str]]:
        """The names of the artifacts at the top, and of those in the folder of figures."""
        return [*(Path(file).name for file in self.files), *self.texts], [Path(file).name for file in self.figures]

    @property
    def hash(self) -> str:
        """SHA-256 (hex) of the content, and of what is infinite."""
        infinite = infinite_of(self.metrics)
        shown = [self.content, infinite] if infinite else self.content
        return hashlib.sha256(json.dumps(shown, sort_keys=True).encode()).hexdigest()


def infinite_of(metrics: Mapping[str, float]) -> dict[str, str]:
    """The tag that names the infinite ones of `metrics`; nothing where there are none. A store would keep them as the
    largest number there is, and nobody tells that from a measured one.
    """
    names = sorted(name for name, value in metrics.items() if math.isinf(value))
    return {INFINITE: ", ".join(names)} if names else {}


def put(client: MlflowClient, experiment: str, record: Record, there: Sequence[Run] | None = None) -> str:
    """Log `record` unless the current run of its key has the same content; return the id of the run.

    A current run of other content is kept, and marked as superseded. The parent is no part of the content: the tag
    follows it. Artifacts that are gone are logged anew.

    Parameters:
        client: of the store.
        experiment: id of the experiment.
        record: what the run shows.
        there: current runs, among them that of the record's key if there is one; None: they are looked up.
    """
    there = find(client, experiment, **{KEY: record.key, CURRENT: YES}) if there is None else there
    old = [run for run in there if run.data.tags.get(KEY) == record.key]
    same = [run for run in old if run.data.tags.get(CONTENT) == record.hash]
    if same:
        run = same[0]
        run_id = str(run.info.run_id)
        if PARENT in record.tags and run.data.tags.get(PARENT) != record.tags[PARENT]:
            client.set_tag(run_id, PARENT, record.tags[PARENT])
        if not are_there(client, run, *record.artifacts()):
            log_artifacts(client, run, record)
        _supersede(client, [other for other in old if other is not run], by=run_id)
        return run_id
    last = {CONTENT: record.hash, CURRENT: YES} | ({SUPERSEDES: str(old[0].info.run_id)} if old else {})
    run_id = _create(client, experiment, record, last)
    # Its end comes last: a run that was cut off is still running, and is swept by the next process.
    client.set_terminated(run_id, end_time=record.started + int(1000 * record.seconds))
    _supersede(client, old, by=run_id)
    return run_id


def update(client: MlflowClient, experiment: str, record: Record) -> str:
    """Log `record` to the one run of its key, which it is written into; return its id. For runs that group others."""
    there = find(client, experiment, **{KEY: record.key, CURRENT: YES})
    if not there:
        return put(client, experiment, record, [])
    run, run_id = there[0], str(there[0].info.run_id)
    if run.data.tags.get(CONTENT) != record.hash or not are_there(client, run, *record.artifacts()):
        log_artifacts(client, run, record)
        if record.inputs:
            client.log_inputs(run_id, list(record.inputs))
        set_tags(client, run_id, {**record.tags, CONTENT: record.hash})
    return run_id


def retire(client: MlflowClient, there: Sequence[Run], keys: Collection[str]) -> None:
    """Mark the current runs `there` whose key is none of `keys`: nothing in the configuration makes them any more."""
    _supersede(client, [run for run in there if run.data.tags[KEY] not in keys], by=NOTHING)


def sweep(client: MlflowClient, experiment: str, **tags: str) -> None:
    """Delete the runs with these tags that a process began and did not end, with their logged models.

    Whoever sweeps holds the lock of what it sweeps, so that nobody is writing them.
    """
    unfinished = find(client, experiment, "attributes.status = 'RUNNING'", **tags)
    for run in unfinished:
        models = client.search_logged_models([experiment], f"source_run_id = '{run.info.run_id}'")
        for model in models:
            client.delete_logged_model(model.model_id)
        client.delete_run(run.info.run_id)
    if unfinished:
        logger.info("removed %d runs from the store that had been cut off while they were logged", len(unfinished))


def find(client: MlflowClient, experiment: str, *conditions: str, **tags: str) -> list[Run]:
    """The experiment's runs with these tags that meet these conditions of MLflow, however many there are."""
    query = " and ".join([*conditions, *(f"tags.`{name}` = '{value}'" for name, value in tags.items())])
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


def set_tags(client: MlflowClient, run_id: str, tags: Mapping[str, str]) -> None:
    """Set tags of a run, in one call to the store."""
    client.log_batch(run_id, tags=_tags(tags))


def _tags(tags: Mapping[str, str]) -> list[RunTag]:
    return [RunTag(name, value) for name, value in tags.items()]


def log_points(client: MlflowClient, run_id: str, points: Sequence[Metric]) -> None:
    """Log any number of points of metrics."""
    for start in range(0, len(points), BATCH):
        client.log_batch(run_id, metrics=points[start : start + BATCH])


def log_artifacts(client: MlflowClient, run: Run, record: Record) -> None:
    """Log the artifacts of a record; those that are there are replaced.

    They go where the run says: each call of the client would ask the store for the run again.
    """
    repository: Any = get_artifact_repository(run.info.artifact_uri, tracking_uri=client.tracking_uri)
    for file in record.files:
        repository.log_artifact(file)
    for file in record.figures:
        repository.log_artifact(file, "figures")
    with tempfile.TemporaryDirectory() as folder:
        for name, text in record.texts.items():
            written = Path(folder, name)
            written.write_text(text, encoding="utf-8", newline="")
            repository.log_artifact(str(written))


def _create(client: MlflowClient, experiment: str, record: Record, last: Mapping[str, str]) -> str:
    """A new run with all that the record shows, and last its metrics and params with the tags `last`; return its id."""
    tags = {KEY: record.key, **record.tags, **infinite_of(record.metrics), CURRENT: NO}
    run = client.create_run(experiment, record.started, tags, record.name)
    run_id, now = str(run.info.run_id), int(time.time() * 1000)
    if record.inputs:
        client.log_inputs(run_id, list(record.inputs))
    log_artifacts(client, run, record)
    points = [(name, 0, value) for name, value in record.metrics.items()] + [*record.curves]
    metrics = [Metric(name, value, now, step) for name, step, value in points if math.isfinite(value)]
    params = [Param(name, str(value)) for name, value in record.params.items()]
    log_points(client, run_id, metrics[BATCH:])
    client.log_batch(run_id, metrics=metrics[:BATCH], params=params, tags=_tags(last))
    return run_id


def _supersede(client: MlflowClient, runs: Sequence[Run], by: str) -> None:
    for run in runs:
        at = str(int(time.time() * 1000))
        set_tags(client, run.info.run_id, {SUPERSEDED_BY: by, SUPERSEDED_AT: at, CURRENT: NO})
