"""Against a real MLflow store in a temporary folder."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from mlflow import MlflowClient

from softkin.tracking import records
from softkin.tracking.records import BATCH, CONTENT, KEY, Record, find, put, retire, sweep, update
from softkin.tracking.store import PARENT

RECORD = Record("nightly/finger/one", "finger · one", {"error": 1.0}, {"kind": "model"}, started=5_000, seconds=2.0)


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


def test_what_is_infinite_is_named_and_no_metric(client: MlflowClient, experiment: str) -> None:
    """A store keeps the largest number there is in its place, which looks like a measured one."""
    metrics = {"test/rmse_mm": 1.5, "test/width_mm_99": math.inf, "test/lowest": -math.inf, "test/undefined": math.nan}
    record = replace(RECORD, metrics=metrics, curves=[("score_mm", 0, math.inf), ("score_mm", 1, 2.0)])
    run = client.get_run(put(client, experiment, record))
    assert run.data.metrics == {"test/rmse_mm": 1.5, "score_mm": 2.0}
    assert run.data.tags["infinite"] == "test/lowest, test/width_mm_99"
    finite = put(client, experiment, replace(record, metrics={"test/rmse_mm": 1.5}))
    assert finite != run.info.run_id
    assert "infinite" not in client.get_run(finite).data.tags


def test_the_same_content_is_logged_once_and_other_content_takes_its_place(
    client: MlflowClient, experiment: str
) -> None:
    first = put(client, experiment, RECORD)
    assert put(client, experiment, replace(RECORD, started=9_000)) == first
    second = put(client, experiment, replace(RECORD, content={"error": 2.0}))
    assert [run.info.run_id for run in find(client, experiment, kind="model", current="true")] == [second]
    assert {run.info.run_id for run in find(client, experiment, kind="model")} == {first, second}


def test_another_parent_is_no_other_content(client: MlflowClient, experiment: str) -> None:
    child = replace(RECORD, tags={**RECORD.tags, PARENT: "one"})
    run = put(client, experiment, child)
    assert put(client, experiment, replace(child, tags={**RECORD.tags, PARENT: "other"})) == run
    assert client.get_run(run).data.tags[PARENT] == "other"


def test_runs_are_found_beyond_the_first_page(
    client: MlflowClient, experiment: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where the last page is full."""
    monkeypatch.setattr(records, "PAGE", 2)
    logged = []
    for place in range(5):
        logged.append(put(client, experiment, replace(RECORD, key=f"nightly/finger/{place}")))
        found = [run.info.run_id for run in find(client, experiment, kind="model")]
        assert sorted(found) == sorted(logged)


def test_a_run_that_was_cut_off_is_swept_with_its_logged_model(client: MlflowClient, experiment: str) -> None:
    half = client.create_run(experiment, tags={"kind": "model", KEY: RECORD.key}).info.run_id
    client.create_logged_model(experiment, name="half", source_run_id=half)
    whole = put(client, experiment, RECORD)
    sweep(client, experiment, kind="intervals")
    assert client.get_run(half).info.lifecycle_stage == "active"
    sweep(client, experiment, kind="model")
    assert client.get_run(half).info.lifecycle_stage == "deleted"
    assert client.search_logged_models([experiment]) == []
    assert [run.info.run_id for run in find(client, experiment, kind="model")] == [whole]


def test_a_run_that_nothing_makes_any_more_is_kept_and_marked(client: MlflowClient, experiment: str) -> None:
    kept = put(client, experiment, RECORD)
    other = put(client, experiment, replace(RECORD, key="nightly/finger/two", tags={"kind": "intervals"}))
    retire(client, find(client, experiment, kind="intervals"), {RECORD.key})
    assert [run.info.run_id for run in find(client, experiment, current="true")] == [kept]
    assert client.get_run(other).data.tags["superseded_by"] == "nothing"


def test_a_run_that_groups_others_is_written_into(client: MlflowClient, experiment: str, tmp_path: Path) -> None:
    first = update(client, experiment, RECORD)
    changed = replace(RECORD, content={"error": 2.0}, tags={"kind": "group"}, texts={"note.md": "Changed."})
    assert update(client, experiment, changed) == first
    run = client.get_run(first)
    assert run.data.tags["kind"] == "group"
    assert run.data.tags[CONTENT] == changed.hash
    assert Path(client.download_artifacts(first, "note.md", str(tmp_path))).read_text() == "Changed."
