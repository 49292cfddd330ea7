"""Stores in files that are moved and copied with their artifacts."""

from __future__ import annotations

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from mlflow import MlflowClient

from softkin.tracking.artifacts import artifacts_beside, folder_of
from softkin.tracking.records import Record, put
from softkin.tracking.store import Campaign, client_of, experiment_of

RECORD = Record("nightly/finger/one", "one", {}, {"kind": "model"}, started=5_000, texts={"card.md": "A card."})


@pytest.fixture
def project(campaign: Campaign, tmp_path: Path) -> Path:
    """A folder with a store and the artifacts of one run, with signs in its name that patterns and URIs treat apart."""
    folder = tmp_path / "a robot_100 %"
    folder.mkdir()
    source = campaign.tracking_uri.removeprefix("sqlite:///")
    with closing(sqlite3.connect(source)) as empty, closing(sqlite3.connect(folder / "mlflow.db")) as copy:
        empty.backup(copy)
    client = opened(folder)
    put(client, experiment_of(client, "finger"), RECORD)
    return folder


def opened(folder: Path) -> MlflowClient:
    return client_of(f"sqlite:///{folder / 'mlflow.db'}")


def location(client: MlflowClient) -> Path:
    (run,) = client.search_runs([experiment_of(client, "finger")])
    return folder_of(str(run.info.artifact_uri))


def test_a_moved_project_finds_its_artifacts(project: Path, tmp_path: Path) -> None:
    moved = tmp_path / "elsewhere"
    project.rename(moved)
    client = opened(moved)
    assert (location(client) / "card.md").read_text() == "A card."
    assert location(client).is_relative_to(moved)


def test_a_copy_never_writes_into_the_original(project: Path, tmp_path: Path) -> None:
    copy = tmp_path / "a copy"
    shutil.copytree(project, copy)
    before = sorted(project.rglob("*"))
    client = opened(copy)
    assert location(client).is_relative_to(copy)
    changed = Record("nightly/finger/two", "two", {}, {}, started=6_000, texts={"card.md": "Another."})
    run = put(client, experiment_of(client, "finger"), changed)
    assert folder_of(client.get_run(run).info.artifact_uri).is_relative_to(copy)
    assert sorted(project.rglob("*")) == before
    assert location(opened(project)).is_relative_to(project)


def test_artifacts_that_are_where_the_store_says_stay_there(project: Path, tmp_path: Path) -> None:
    """A store whose artifacts are elsewhere on purpose, and not beside it."""
    alone = tmp_path / "alone"
    alone.mkdir()
    with closing(sqlite3.connect(project / "mlflow.db")) as store, closing(sqlite3.connect(alone / "mlflow.db")) as one:
        store.backup(one)
    assert location(opened(alone)).is_relative_to(artifacts_beside(project / "mlflow.db"))
