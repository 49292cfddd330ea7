"""Against a real MLflow store in a temporary folder."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from mlflow import MlflowClient

from softkin.core.files import read_json
from softkin.core.samples import SUBSETS
from softkin.tracking.artifacts import folder_of
from softkin.tracking.intervals import log_intervals
from softkin.tracking.models import log_dataset
from softkin.tracking.records import KEY
from softkin.tracking.saved_view import TAG
from softkin.tracking.store import NOTE, PARENT, Campaign
from tests.unit.tracking.conftest import client_of_store, snapshot


def test_a_run_shows_its_parameters_metrics_history_data_and_files(campaign: Campaign, results: dict[str, Any]) -> None:
    logged = log_dataset(campaign, **results)
    client = client_of_store(campaign)
    run = client.get_run(logged["svr/tuned"])
    assert run.info.run_name == "finger · svr · tuned"
    assert run.info.status == "FINISHED"
    assert run.data.params == {"C": "1.0", "kernel": "rbf", "target_space": "cartesian"}
    assert {f"{subset}/rmse_mm" for subset in SUBSETS} <= set(run.data.metrics)
    assert run.data.metrics["fit_seconds"] == 3.0
    assert run.data.metrics["cv_mae_mm"] == 0.5
    assert run.data.metrics["shell_mae_mm"] == 0.7
    assert run.data.tags[PARENT] == logged["campaign"]
    for tag, value in {"dataset": "finger", "preset": "tuned", "seed": "5", "data_sha256": "ab" * 32}.items():
        assert run.data.tags[tag] == value
    assert {"git_commit", "softkin_version"} <= set(run.data.tags)
    history = client.get_metric_history(run.info.run_id, "trials/best_score_mm")
    assert [(metric.step, metric.value) for metric in history] == [(0, 0.9), (2, 0.5)]
    assert run.inputs.dataset_inputs[0].dataset.name == "finger"
    artifacts = {file.path for file in client.list_artifacts(run.info.run_id)}
    assert artifacts == {"model.joblib", "predictions.parquet", "trials.csv", "parameters.json", "fit.json", "figures"}
    assert run.info.end_time - run.info.start_time == 3000  # the table shows it as the duration: it is that of the fit


def test_a_run_shows_the_figures_that_show_it(campaign: Campaign, results: dict[str, Any]) -> None:
    logged = log_dataset(campaign, **results)
    client = client_of_store(campaign)
    shown = {name: {file.path for file in client.list_artifacts(run, "figures")} for name, run in logged.items()}
    assert shown == {
        "campaign": {"figures/distribution.png"},
        "svr/paper": {"figures/ranking.png"},
        "svr/tuned": {"figures/ranking.png", "figures/tuning_history.png"},
    }
    (results["figures"] / "tuning_history.png").write_text("drawn anew")
    again = log_dataset(campaign, **results)
    assert [name for name in logged if again[name] != logged[name]] == ["svr/tuned"]


def test_the_run_that_groups_them_is_written_into(campaign: Campaign, results: dict[str, Any]) -> None:
    first = log_dataset(campaign, **results)
    (results["figures"] / "distribution.png").write_text("drawn anew")
    assert log_dataset(campaign, **results) == first
    client = client_of_store(campaign)
    folder = folder_of(client.get_run(first["campaign"]).info.artifact_uri)
    assert (folder / "figures" / "distribution.png").read_text() == "drawn anew"
    children = [run["data"]["tags"].get(PARENT) for run in snapshot(campaign).values()]
    assert sorted(children, key=str) == sorted([None, first["campaign"], first["campaign"]], key=str)


def test_the_newest_runs_are_the_campaign_then_its_models_then_their_intervals(
    campaign: Campaign, results: dict[str, Any], interval_files: dict[str, Path]
) -> None:
    log_intervals(campaign, **interval_files, parents=log_dataset(campaign, **results))
    newest = sorted(snapshot(campaign).values(), key=lambda run: -run["info"]["start_time"])
    assert [run["data"]["tags"]["kind"] for run in newest] == ["campaign", "model", "model", "intervals", "intervals"]


def test_an_experiment_has_a_note_and_a_view_of_metrics_that_are_there(
    campaign: Campaign, results: dict[str, Any]
) -> None:
    logged = log_dataset(campaign, **results)
    client = client_of_store(campaign)
    tags = client.get_experiment_by_name("finger").tags
    assert "Nine rows of test stand in train" in tags["mlflow.note.content"]
    view = json.loads(tags[TAG])
    state = json.loads(zlib.decompress(base64.b64decode(view["state"].removeprefix("deflate;"))))
    run = client.get_run(logged["svr/tuned"]).data
    shown = {f"metrics.`{name}`" for name in run.metrics} | {f"tags.`{name}`" for name in run.tags}
    assert set(state["selectedColumns"]) <= shown
    assert state["orderByKey"] == "metrics.`test/euclidean_mean_mm`"
    experiment = client.get_experiment_by_name("finger").experiment_id
    assert len(client.search_runs([experiment], state["searchFilter"])) == 2


def test_logging_again_changes_nothing(campaign: Campaign, results: dict[str, Any]) -> None:
    first = log_dataset(campaign, **results)
    before = snapshot(campaign)
    assert log_dataset(campaign, **results) == first
    assert snapshot(campaign) == before
    assert len(before) == 3


def test_a_caution_stands_in_each_description_and_supersedes_the_runs_without(
    campaign: Campaign, results: dict[str, Any], interval_files: dict[str, Path]
) -> None:
    careful = replace(campaign, caution="Few trials.")
    plain = log_dataset(campaign, **results)
    log_intervals(campaign, **interval_files, parents=plain)
    without = set(snapshot(campaign))
    for _ in range(2):
        logged = log_dataset(careful, **results)
        log_intervals(careful, **interval_files, parents=logged)
        runs = snapshot(campaign)
        assert without & set(runs) == {plain["campaign"]}  # the run that groups them is written into
        assert len(runs) == len(without)
        assert all("**caution**: Few trials." in run["data"]["tags"][NOTE] for run in runs.values())
    tags = client_of_store(campaign).get_experiment_by_name("finger").tags
    assert "**caution**: Few trials." in tags[NOTE]


def test_other_timings_alone_are_no_new_result(campaign: Campaign, results: dict[str, Any]) -> None:
    first = log_dataset(campaign, **results)
    point = pd.read_csv(results["point"])
    point.assign(fit_seconds=99.0).to_csv(results["point"], index=False)
    assert log_dataset(campaign, **results) == first


def test_a_changed_result_supersedes_its_run_and_no_other(campaign: Campaign, results: dict[str, Any]) -> None:
    first = log_dataset(campaign, **results)
    Path(results["runs"]["svr", "tuned"]["predictions"]).write_text("moved")
    second = log_dataset(campaign, **results)
    assert second["svr/paper"] == first["svr/paper"]
    assert second["svr/tuned"] != first["svr/tuned"]
    assert set(snapshot(campaign)) == set(second.values())
    client = client_of_store(campaign)
    old, new = (client.get_run(logged["svr/tuned"]).data.tags for logged in (first, second))
    assert old["superseded_by"] == second["svr/tuned"]
    assert old["current"] == "false"
    assert new["supersedes"] == first["svr/tuned"]
    assert len(snapshot(campaign, all_of_them=True)) == len(first) + 1


def test_a_result_that_returns_is_a_new_run_after_the_one_between(campaign: Campaign, results: dict[str, Any]) -> None:
    predictions = Path(results["runs"]["svr", "tuned"]["predictions"])
    logged = []
    for text in ("one", "other", "one"):
        predictions.write_text(text)
        logged.append(log_dataset(campaign, **results)["svr/tuned"])
    assert len(set(logged)) == 3
    tags = [client_of_store(campaign).get_run(run).data.tags for run in logged]
    assert [run.get("superseded_by") for run in tags] == [*logged[1:], None]
    assert [run.get("supersedes") for run in tags] == [None, *logged[:-1]]


def test_a_run_cut_off_before_its_end_is_removed_and_made_again(campaign: Campaign, results: dict[str, Any]) -> None:
    client = client_of_store(campaign)
    write = MlflowClient.log_batch
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(MlflowClient, "log_batch", lambda *args, **keys: cut_off(write, args, keys))
        with pytest.raises(KeyboardInterrupt):
            log_dataset(campaign, **results)
    half = snapshot(campaign, all_of_them=True)
    assert "RUNNING" in {run["info"]["status"] for run in half.values()}
    logged = log_dataset(campaign, **results)
    assert set(snapshot(campaign, all_of_them=True)) == set(logged.values())
    assert {client.get_run(run).info.status for run in logged.values()} == {"FINISHED"}


def cut_off(write: Callable[..., object], args: Sequence[Any], keys: Mapping[str, Any]) -> None:
    """What `log_batch` of MLflow's client does, until a run has parameters."""
    if keys.get("params"):
        raise KeyboardInterrupt
    write(*args, **keys)


def test_a_model_that_left_the_pool_is_current_no_more(campaign: Campaign, results: dict[str, Any]) -> None:
    first = log_dataset(campaign, **results)
    del results["runs"]["svr", "paper"]
    logged = log_dataset(campaign, **results)
    assert set(snapshot(campaign)) == set(logged.values())
    gone = client_of_store(campaign).get_run(first["svr/paper"])
    assert gone.data.tags["superseded_by"] == "nothing"
    assert gone.info.lifecycle_stage == "active"


def test_artifacts_that_are_gone_are_logged_anew(campaign: Campaign, results: dict[str, Any]) -> None:
    first = log_dataset(campaign, **results)
    client = client_of_store(campaign)
    folder = folder_of(client.get_run(first["svr/tuned"]).info.artifact_uri)
    (folder / "model.joblib").unlink()
    (folder / "figures" / "ranking.png").unlink()
    assert log_dataset(campaign, **results) == first
    assert (folder / "model.joblib").read_text() == "fitted"
    assert (folder / "figures" / "ranking.png").read_text() == "drawn"


def test_campaigns_stand_side_by_side(campaign: Campaign, results: dict[str, Any]) -> None:
    one = log_dataset(campaign, **results)
    other = log_dataset(replace(campaign, name="weekly"), **results)
    assert not set(one.values()) & set(other.values())
    assert set(snapshot(campaign)) == set(one.values()) | set(other.values())


def test_keys_are_tags_that_can_be_searched(campaign: Campaign, results: dict[str, Any]) -> None:
    logged = log_dataset(campaign, **results)
    run = client_of_store(campaign).get_run(logged["svr/paper"])
    assert run.data.tags[KEY] == "nightly/finger/svr/paper"
    assert run.data.tags["leak"] == "true"
    assert "Nine rows of test stand in train" in run.data.tags["mlflow.note.content"]
    assert read_json(results["description"])["dataset"] == "finger"
