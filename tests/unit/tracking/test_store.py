"""Against a real MLflow store in a temporary folder."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from mlflow import MlflowClient
from mlflow.entities import ViewType

from softkin.core.errors import StoreError
from softkin.core.files import write_json
from softkin.tracking import Campaign, store
from softkin.tracking.store import (
    BATCH,
    CONTENT,
    KEY,
    PARENT,
    Record,
    client_of,
    common_tags,
    delete,
    experiment_of,
    find,
    put,
    read_description,
)

RECORD = Record("nightly/finger/one", "finger · one", {"error": 1.0}, {"kind": "model"}, started=5_000, seconds=2.0)


@pytest.fixture
def client(campaign: Campaign) -> MlflowClient:
    return client_of(campaign.tracking_uri)


@pytest.fixture
def experiment(client: MlflowClient, campaign: Campaign) -> str:
    return experiment_of(client, "finger", campaign.artifacts)


def test_a_lost_store_is_an_error_with_a_fix(tmp_path: Path) -> None:
    uri = f"sqlite:///{tmp_path / 'none.db'}"
    with pytest.raises(StoreError, match="gone") as error:
        client_of(uri)
    assert error.value.where == uri
    assert "make store" in str(error.value.fix)
    assert not (tmp_path / "none.db").exists()


def test_four_processes_may_create_the_store_at_once(tmp_path: Path) -> None:
    code = f"from softkin.tracking import create_store; create_store('sqlite:///{tmp_path / 'mlflow.db'}')"
    processes = [subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.DEVNULL) for _ in range(4)]
    assert [process.wait() for process in processes] == [0, 0, 0, 0]
    client = MlflowClient(f"sqlite:///{tmp_path / 'mlflow.db'}")
    assert [e.name for e in client.search_experiments(view_type=ViewType.ALL)] == ["Default"]


def test_a_description_has_the_findings_of_the_data_card(tmp_path: Path) -> None:
    write_json(tmp_path / "dataset.json", {"dataset": "finger"})
    write_json(tmp_path / "data_card.json", {"findings": [], "is_leaking": False})
    described = read_description(tmp_path / "dataset.json", tmp_path / "data_card.json")
    assert described == {"dataset": "finger", "findings": []}


@pytest.mark.parametrize(("severity", "leak"), [("leak", "true"), ("warning", "false")])
def test_tags_say_where_the_data_come_from_and_whether_they_leak(campaign: Campaign, severity: str, leak: str) -> None:
    description = {"dataset": "finger", "sha256": "ab", "origin": "published", "findings": [{"severity": severity}]}
    assert common_tags(campaign, description) == {
        **{"campaign": "nightly", "dataset": "finger", "data_sha256": "ab", "origin": "published", "seed": "5"},
        "leak": leak,
    }


def test_a_deleted_experiment_comes_back(client: MlflowClient, campaign: Campaign, experiment: str) -> None:
    client.delete_experiment(experiment)
    assert experiment_of(client, "finger", campaign.artifacts) == experiment
    assert client.get_experiment(experiment).lifecycle_stage == "active"


def test_a_run_shows_its_record(client: MlflowClient, experiment: str, tmp_path: Path) -> None:
    (tmp_path / "fit.json").write_text("{}")
    (tmp_path / "robot.png").write_text("drawn")
    curves = [("trials/score_mm", step, float(step)) for step in range(BATCH + 5)]
    record = replace(RECORD, metrics={"rmse_mm": 1.5}, curves=curves, params={"C": 1.0}, texts={"card.md": "A card."})
    record = replace(record, files=[str(tmp_path / "fit.json")], figures=[str(tmp_path / "robot.png")])
    run = client.get_run(put(client, experiment, record))
    assert (run.info.run_name, run.info.status) == ("finger · one", "FINISHED")
    assert (run.info.start_time, run.info.end_time) == (5_000, 7_000)
    assert run.data.metrics == {"rmse_mm": 1.5, "trials/score_mm": float(BATCH + 4)}
    assert run.data.params == {"C": "1.0"}
    assert len(client.get_metric_history(run.info.run_id, "trials/score_mm")) == BATCH + 5
    assert {file.path for file in client.list_artifacts(run.info.run_id)} == {"card.md", "fit.json", "figures"}


def test_the_same_content_is_logged_once_and_other_content_takes_its_place(
    client: MlflowClient, experiment: str
) -> None:
    first = put(client, experiment, RECORD)
    assert put(client, experiment, replace(RECORD, started=9_000)) == first
    second = put(client, experiment, replace(RECORD, content={"error": 2.0}))
    assert [run.info.run_id for run in find(client, experiment, kind="model")] == [second]


def test_another_parent_is_no_other_content(client: MlflowClient, experiment: str) -> None:
    child = replace(RECORD, tags={**RECORD.tags, PARENT: "one"})
    run = put(client, experiment, child)
    assert put(client, experiment, replace(child, tags={**RECORD.tags, PARENT: "other"})) == run
    assert client.get_run(run).data.tags[PARENT] == "other"


def test_runs_are_found_beyond_the_first_page(
    client: MlflowClient, experiment: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where the last page is full."""
    monkeypatch.setattr(store, "PAGE", 2)
    logged = []
    for place in range(5):
        logged.append(put(client, experiment, replace(RECORD, key=f"nightly/finger/{place}")))
        found = [run.info.run_id for run in find(client, experiment, kind="model")]
        assert sorted(found) == sorted(logged)


def test_a_run_that_was_cut_off_is_logged_again(client: MlflowClient, experiment: str) -> None:
    first = put(client, experiment, RECORD)
    client.delete_tag(first, CONTENT)
    second = put(client, experiment, RECORD)
    assert second != first
    assert [run.info.run_id for run in find(client, experiment, **{KEY: RECORD.key})] == [second]


def test_runs_are_looked_up_by_their_tags_until_deleted(client: MlflowClient, experiment: str) -> None:
    put(client, experiment, RECORD)
    other = put(client, experiment, replace(RECORD, key="nightly/finger/two", tags={"kind": "intervals"}))
    runs = find(client, experiment, kind="intervals")
    assert [run.info.run_id for run in runs] == [other]
    delete(client, runs)
    assert find(client, experiment, kind="intervals") == []
