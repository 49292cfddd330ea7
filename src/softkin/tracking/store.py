"""Make and open the MLflow store, and say what the runs of a campaign have in common."""

from __future__ import annotations

import glob
import logging
import sqlite3
import time
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mlflow
from filelock import FileLock
from mlflow import MlflowClient
from mlflow.exceptions import MlflowException
from mlflow.store.db.utils import _initialize_tables
from sqlalchemy import create_engine
from sqlalchemy.pool import NullPool

from softkin.core.addresses import SQLITE
from softkin.core.errors import StoreError
from softkin.core.escaping import markdown_text
from softkin.core.files import read_json, replacing
from softkin.core.units import MM, own_unit, unit_of
from softkin.core.urls import without_credentials
from softkin.data.audit.findings import LEAK
from softkin.tracking.artifacts import artifacts_beside, move_locations
from softkin.tracking.open_store import check_file
from softkin.tracking.server import check_answers

logger = logging.getLogger("softkin")

PARENT, NOTE = "mlflow.parentRunId", "mlflow.note.content"


@dataclass(frozen=True, slots=True)
class Campaign:
    """One complete run of the workflow on one configuration: its name, its seed, where its store is, and what it says
    of its own numbers.
    """

    name: str
    seed: int
    tracking_uri: str
    caution: str | None = None
    #: Milliseconds. The UI sorts runs by their start, newest first.
    started: int = field(default_factory=lambda: int(time.time() * 1000))


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
        **own_unit(unit_of(description)),
    }


def unit_note(description: Mapping[str, Any]) -> str:
    """What a description in MLflow says of a unit that is not mm: metrics are named alike for all robots."""
    unit = unit_of(description)
    return "" if unit == MM else f" Lengths are in {unit}, those of metrics whose names end in `_mm`, too."


def caution_note(campaign: Campaign) -> str:
    """The end of each description in MLflow: what the configuration says of its own numbers, if anything."""
    return f"\n\n**caution**: {markdown_text(campaign.caution)}" if campaign.caution else ""


def caution_content(campaign: Campaign) -> dict[str, str]:
    """The same as a part of a record's content: runs without a caution keep the content that they had."""
    return {"caution": campaign.caution} if campaign.caution else {}


def create_store(tracking_uri: str) -> None:
    """Create the MLflow store if there is none. One job does this before any other opens it: first use is a race.

    Raises:
        StoreError: there is one that cannot be used, or a server does not answer.
    """
    if tracking_uri.startswith(SQLITE):
        file = Path(tracking_uri.removeprefix(SQLITE)).resolve()
        with FileLock(f"{file}.lock"):
            if file.exists() and (file.is_dir() or file.stat().st_size):  # an empty one becomes a store
                check_file(file)
            else:
                _make(file)
            MlflowClient(tracking_uri).search_experiments(max_results=1)
    else:
        check_answers(tracking_uri)
        MlflowClient(tracking_uri).search_experiments(max_results=1)
    logger.info("the MLflow store is %s", without_credentials(tracking_uri))


def _make(file: Path) -> None:
    """Make a store that has its name when it is whole: MLflow refuses one with half of its tables, which is what a
    process that is killed while MLflow makes them leaves.
    """
    for left in file.parent.glob(f".{glob.escape(file.name)}.*.part*"):
        left.unlink()
    with replacing(file) as temporary:
        engine = create_engine(f"{SQLITE}{temporary}", poolclass=NullPool)
        _initialize_tables(engine)  # type: ignore[no-untyped-call]
        engine.dispose()
        with closing(sqlite3.connect(temporary)) as connection:
            connection.execute("PRAGMA journal_mode=WAL")


def client_of(tracking_uri: str) -> MlflowClient:
    """An MLflow client of a store that exists, which becomes MLflow's default store.

    Some of MLflow's calls ask the default store whatever client they are made by, and make one in the working folder
    where nobody named it. Locations of artifacts in a store that was moved or copied are corrected.

    Raises:
        StoreError: the store is gone or cannot be used, or its server does not answer.
    """
    check_answers(tracking_uri)
    if tracking_uri.startswith(SQLITE):
        file = Path(tracking_uri.removeprefix(SQLITE))
        if not file.exists():
            raise StoreError(
                "the MLflow store is gone",
                where=without_credentials(tracking_uri),
                fix="make it again from results/: make store",
            )
        check_file(file)
        move_locations(file)
    mlflow.set_tracking_uri(tracking_uri)
    mlflow.set_registry_uri(tracking_uri)
    return MlflowClient(tracking_uri, tracking_uri)


def experiment_of(client: MlflowClient, name: str) -> str:
    """Id of the experiment of that name; created, or restored, when it is not there."""
    experiment = client.get_experiment_by_name(name)
    if experiment is None:
        return _create_experiment(client, name)
    if experiment.lifecycle_stage == "deleted":
        client.restore_experiment(experiment.experiment_id)
    return str(experiment.experiment_id)


def _create_experiment(client: MlflowClient, name: str) -> str:
    """A new experiment, or the one that another process has made in the meantime."""
    is_file = client.tracking_uri.startswith(SQLITE)
    file = client.tracking_uri.removeprefix(SQLITE)
    location = (artifacts_beside(file) / name).as_uri() if is_file else None
    try:
        return str(client.create_experiment(name, artifact_location=location))
    except MlflowException as error:
        made = client.get_experiment_by_name(name)
        if error.error_code != "RESOURCE_ALREADY_EXISTS" or made is None:
            raise
        return str(made.experiment_id)
