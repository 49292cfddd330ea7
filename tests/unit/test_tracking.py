"""Against a real MLflow store in a temporary folder."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from mlflow import MlflowClient
from mlflow.entities import ViewType

from softkin.files import read_json, write_json
from softkin.interface import SUBSETS, SoftkinError
from softkin.tracking import Campaign, create_store, log_dataset, log_intervals
from softkin.tracking.store import CONTENT, KEY, PARENT

ABOUT = {
    "dataset": "finger",
    "title": "FINGER",
    "sha256": "ab" * 32,
    "origin": "published",
    "n_commands": 2,
    "n_markers": 1,
}


@pytest.fixture
def campaign(tmp_path: Path) -> Campaign:
    uri = f"sqlite:///{tmp_path / 'mlflow.db'}"
    create_store(uri)
    return Campaign("nightly", seed=5, tracking_uri=uri, artifacts=str(tmp_path / "artifacts"))


@pytest.fixture
def results(tmp_path: Path) -> dict[str, Any]:
    """Result files of two runs of one dataset."""
    write_json(tmp_path / "dataset.json", ABOUT | {"rows": dict.fromkeys(SUBSETS, 9)})
    finding = {"severity": "leak", "sentence": "Nine rows of test stand in train."}
    write_json(tmp_path / "data_card.json", {"findings": [finding]})
    runs: dict[tuple[str, str], dict[str, str]] = {}
    rows = []
    for model, preset in (("svr", "paper"), ("svr", "tuned")):
        folder = tmp_path / model / preset
        files = {name: str(folder / f"{name}.json") for name in ("fit", "parameters")}
        write_json(files["fit"], {"params": {"C": 1.0, "kernel": "rbf"}})
        (folder / "predictions.parquet").write_text(f"{model} {preset}")
        files["predictions"] = str(folder / "predictions.parquet")
        if preset == "tuned":
            write_json(files["parameters"], {"cv_mae_mm": 0.5, "fingerprint": "f", "n_trials": 3})
            files["trials"] = str(folder / "trials.csv")
            table = pd.DataFrame({"trial": [0, 1, 2], "state": "COMPLETE", "cv_mae_mm": [0.9, None, 0.5]})
            table.to_csv(files["trials"], index=False)
        else:
            del files["parameters"]
        runs[model, preset] = files
        for subset in SUBSETS:
            key = {"dataset": "finger", "subset": subset, "model": model, "preset": preset}
            rows.append(key | {"rmse_mm": 1.5, "euclidean_mean_mm": 2.0, "fit_seconds": 3.0, "predict_us_per_row": 4.0})
    pd.DataFrame(rows).to_csv(tmp_path / "point.csv", index=False)
    files = {"description": "dataset.json", "data_card": "data_card.json", "point": "point.csv"}
    return {name: tmp_path / file for name, file in files.items()} | {"runs": runs}


def snapshot(campaign: Campaign) -> dict[str, Any]:
    client = MlflowClient(campaign.tracking_uri)
    experiments = [e.experiment_id for e in client.search_experiments() if e.name == "finger"]
    return {run.info.run_id: run.to_dictionary() for run in client.search_runs(experiments, max_results=1000)}


def test_a_run_shows_its_parameters_metrics_history_data_and_files(campaign: Campaign, results: dict[str, Any]) -> None:
    logged = log_dataset(campaign, **results)
    client = MlflowClient(campaign.tracking_uri)
    run = client.get_run(logged["svr/tuned"])
    assert run.info.run_name == "finger · svr · tuned"
    assert run.info.status == "FINISHED"
    assert run.data.params == {"C": "1.0", "kernel": "rbf"}
    assert {f"{subset}/rmse_mm" for subset in SUBSETS} <= set(run.data.metrics)
    assert run.data.metrics["fit_seconds"] == 3.0
    assert run.data.metrics["cv_mae_mm"] == 0.5
    assert run.data.tags[PARENT] == logged["campaign"]
    for tag, value in {"dataset": "finger", "preset": "tuned", "seed": "5", "data_sha256": "ab" * 32}.items():
        assert run.data.tags[tag] == value
    assert {"git_commit", "softkin_version"} <= set(run.data.tags)
    history = client.get_metric_history(run.info.run_id, "trials/best_cv_mae_mm")
    assert [(metric.step, metric.value) for metric in history] == [(0, 0.9), (2, 0.5)]
    assert run.inputs.dataset_inputs[0].dataset.name == "finger"
    artifacts = {file.path for file in client.list_artifacts(run.info.run_id)}
    assert artifacts == {"predictions.parquet", "trials.csv", "parameters.json", "fit.json"}


def test_logging_again_changes_nothing(campaign: Campaign, results: dict[str, Any]) -> None:
    first = log_dataset(campaign, **results)
    before = snapshot(campaign)
    assert log_dataset(campaign, **results) == first
    assert snapshot(campaign) == before
    assert len(before) == 3


def test_other_timings_alone_are_no_new_result(campaign: Campaign, results: dict[str, Any]) -> None:
    first = log_dataset(campaign, **results)
    point = pd.read_csv(results["point"])
    point.assign(fit_seconds=99.0).to_csv(results["point"], index=False)
    assert log_dataset(campaign, **results) == first


def test_a_changed_result_replaces_its_run_and_no_other(campaign: Campaign, results: dict[str, Any]) -> None:
    first = log_dataset(campaign, **results)
    Path(results["runs"]["svr", "tuned"]["predictions"]).write_text("moved")
    second = log_dataset(campaign, **results)
    assert second["svr/paper"] == first["svr/paper"]
    assert second["svr/tuned"] != first["svr/tuned"]
    assert set(snapshot(campaign)) == set(second.values())


def test_a_run_cut_off_before_its_end_is_made_again(campaign: Campaign, results: dict[str, Any]) -> None:
    first = log_dataset(campaign, **results)
    client = MlflowClient(campaign.tracking_uri)
    client.delete_tag(first["svr/paper"], CONTENT)  # it is written last
    second = log_dataset(campaign, **results)
    assert second["svr/paper"] != first["svr/paper"]
    assert len(snapshot(campaign)) == 3


def test_a_model_that_left_the_pool_leaves_the_store(campaign: Campaign, results: dict[str, Any]) -> None:
    log_dataset(campaign, **results)
    del results["runs"]["svr", "paper"]
    logged = log_dataset(campaign, **results)
    assert set(snapshot(campaign)) == set(logged.values())


def test_campaigns_stand_side_by_side(campaign: Campaign, results: dict[str, Any]) -> None:
    one = log_dataset(campaign, **results)
    other = log_dataset(replace(campaign, name="weekly"), **results)
    assert not set(one.values()) & set(other.values())
    assert set(snapshot(campaign)) == set(one.values()) | set(other.values())


def test_a_lost_store_is_an_error_with_a_mend(tmp_path: Path, results: dict[str, Any]) -> None:
    lost = Campaign("nightly", 0, f"sqlite:///{tmp_path / 'none.db'}", str(tmp_path))
    with pytest.raises(SoftkinError, match="make store"):
        log_dataset(lost, **results)
    assert not (tmp_path / "none.db").exists()


def test_four_processes_may_create_the_store_at_once(tmp_path: Path) -> None:
    code = f"from softkin.tracking import create_store; create_store('sqlite:///{tmp_path / 'mlflow.db'}')"
    processes = [subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.DEVNULL) for _ in range(4)]
    assert [process.wait() for process in processes] == [0, 0, 0, 0]
    client = MlflowClient(f"sqlite:///{tmp_path / 'mlflow.db'}")
    assert [e.name for e in client.search_experiments(view_type=ViewType.ALL)] == ["Default"]


def test_keys_are_tags_that_can_be_searched(campaign: Campaign, results: dict[str, Any]) -> None:
    logged = log_dataset(campaign, **results)
    run = MlflowClient(campaign.tracking_uri).get_run(logged["svr/paper"])
    assert run.data.tags[KEY] == "nightly/finger/svr/paper"
    assert run.data.tags["leak"] == "true"
    assert "Nine rows of test stand in train" in run.data.tags["mlflow.note.content"]
    assert read_json(results["description"])["dataset"] == "finger"


@pytest.fixture
def interval_files(tmp_path: Path) -> dict[str, Path]:
    rows = []
    for method in ("qr", "scp_mapie"):
        for subset in ("test", "extrapolation"):
            for coordinate in ("m1_x", "mean_informative", "joint"):
                key = {"dataset": "finger", "subset": subset, "model": "svr", "preset": "tuned"}
                values = {"coverage": 0.91, "mean_width_mm": 2.0, "infinite_share": 0.0, "crossing_share": 0.0}
                values |= {"crps_mm": float("nan"), "size_mm": 2.5 if coordinate == "joint" else float("nan")}
                values["winkler_mm"] = float("inf") if coordinate == "joint" else 3.0
                rows.append(
                    key | {"interval_method": method, "coordinate": coordinate, "confidence_level": 0.9} | values
                )
    pd.DataFrame(rows).to_csv(tmp_path / "intervals.csv", index=False)
    (tmp_path / "figures").mkdir()
    index = {"figure": "intervals_chosen", "title": "t", "model": "svr", "preset": "tuned"}
    pd.DataFrame([index | {"interval_method": "scp_mapie"}]).to_csv(tmp_path / "figures" / "index.csv", index=False)
    for ending in ("png", "csv"):
        (tmp_path / "figures" / f"intervals_chosen.{ending}").write_text("drawn")
    return {"metrics": tmp_path / "intervals.csv", "figures": tmp_path / "figures"}


def test_interval_runs_hang_on_their_model_and_are_logged_once(
    campaign: Campaign, results: dict[str, Any], interval_files: dict[str, Path]
) -> None:
    logged = log_dataset(campaign, **results)
    assert (
        log_intervals(
            campaign,
            dataset="finger",
            **interval_files,
            parents=logged,
        )
        == 2
    )
    before = snapshot(campaign)
    nested = [run for run in before.values() if run["data"]["tags"].get("interval_method") == "scp_mapie"]
    assert [run["data"]["tags"][PARENT] for run in nested] == [logged["svr/tuned"]]
    assert nested[0]["data"]["metrics"]["test/coverage_90"] == 0.91
    assert nested[0]["data"]["metrics"]["extrapolation/joint_coverage_90"] == 0.91
    assert "test/joint_winkler_mm_90" not in nested[0]["data"]["metrics"]
    client = MlflowClient(campaign.tracking_uri)
    pictures = client.list_artifacts(nested[0]["info"]["run_id"], "figures")
    assert [picture.path for picture in pictures] == ["figures/intervals_chosen.png"]
    log_intervals(
        campaign,
        dataset="finger",
        **interval_files,
        parents=log_dataset(campaign, **results),
    )
    assert snapshot(campaign) == before


def test_all_shapes_of_region_share_a_run(
    campaign: Campaign, results: dict[str, Any], interval_files: dict[str, Path]
) -> None:
    table = pd.read_csv(interval_files["metrics"])
    joint = table[(table["interval_method"] == "qr") & (table["coordinate"] == "joint")]
    shapes = [joint.assign(interval_method=name) for name in ("joint_box", "joint_balls")]
    pd.concat([table, *shapes]).to_csv(interval_files["metrics"], index=False)
    logged = log_dataset(campaign, **results)
    assert (
        log_intervals(
            campaign,
            dataset="finger",
            **interval_files,
            parents=logged,
        )
        == 3
    )
    runs = [run["data"] for run in snapshot(campaign).values()]
    (regions,) = [run for run in runs if run["tags"].get("interval_method") == "joint_regions"]
    assert regions["tags"][PARENT] == logged["svr/tuned"]
    assert regions["metrics"]["test/joint_box_size_mm_90"] == 2.5
    assert regions["metrics"]["extrapolation/joint_balls_coverage_90"] == 0.91
    assert "joint_box covers 91.0%" in regions["tags"]["mlflow.note.content"]


def test_interval_runs_follow_a_replaced_model_and_leave_with_their_method(
    campaign: Campaign, results: dict[str, Any], interval_files: dict[str, Path]
) -> None:
    first = log_dataset(campaign, **results)
    log_intervals(campaign, dataset="finger", **interval_files, parents=first)
    Path(results["runs"]["svr", "tuned"]["predictions"]).write_text("moved")
    second = log_dataset(campaign, **results)
    table = pd.read_csv(interval_files["metrics"])
    table[table["interval_method"] == "qr"].to_csv(interval_files["metrics"], index=False)
    assert (
        log_intervals(
            campaign,
            dataset="finger",
            **interval_files,
            parents=second,
        )
        == 1
    )
    nested = [run for run in snapshot(campaign).values() if "interval_method" in run["data"]["tags"]]
    assert [run["data"]["tags"][PARENT] for run in nested] == [second["svr/tuned"]]
