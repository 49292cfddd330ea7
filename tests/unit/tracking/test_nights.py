"""Campaigns in a real MLflow store."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd

from softkin.campaigns.summary import FORMAT
from softkin.tracking.nights import (
    JUDGED_IN,
    Candidate,
    NightRecord,
    candidates,
    last_night,
    log_night,
    move_champions,
    nights,
)
from softkin.tracking.promotion import REASON, aliases_of, nominate
from softkin.tracking.store import experiment_of

NAME = "softkin-finger"
ROWS = pd.DataFrame({"dataset": ["finger"], "error_mm": [1.5]})


def summary(configuration: str = "a", name: str = "nightly") -> dict[str, Any]:
    deployed = {"model": "gp", "preset": "tuned", "interval_method": "scp_mapie", "outside": "auto"}
    data = {"sha256": "ab", "deployed": deployed, "metrics": {"test/rmse_mm": 1.5, "test/mean_width_mm_90": None}}
    sums = {"configuration_sha256": configuration, "software_sha256": "s"}
    return {"format": FORMAT, "campaign": name, **sums, "datasets": {"finger": data}}


def logged(client: Any, folder: Path, outcome: str = "same", started: float = 1.0, **keys: Any) -> str:
    rows = folder / "summary_rows.parquet"
    ROWS.to_parquet(rows)
    (folder / "report.html").write_text("a page")
    verdict = {"outcome": outcome, "exit_code": 0, "duration_seconds": 9.5, "jobs_run": 3, "commit": "c"}
    sums = None if outcome == "failed" else keys.pop("summary", summary())
    files = {"": [folder / "report.html"]}
    return log_night(client, NightRecord(verdict, "A page.", sums, rows, files, started))


def test_a_campaign_is_a_run_of_its_own_with_all_headline_metrics(client: Any, tmp_path: Path) -> None:
    run = client.get_run(logged(client, tmp_path))
    assert run.data.metrics == {"finger/test/rmse_mm": 1.5, "duration_seconds": 9.5, "jobs_run": 3.0, "exit_code": 0.0}
    assert run.data.tags["infinite"] == "finger/test/mean_width_mm_90"
    assert run.data.tags["verdict"] == "same"
    assert run.data.tags["deployed.finger"] == "gp tuned scp_mapie"
    assert run.data.tags["data_sha256.finger"] == "ab"
    assert run.data.tags["commit"] == "c"
    artifacts = {file.path for file in client.list_artifacts(run.info.run_id)}
    assert artifacts == {"report.html", "verdict.json", "verdict.md", "summary.json", "summary_rows.parquet"}
    assert client.get_experiment(run.info.experiment_id).name == "campaigns"


def test_nights_are_kept_and_the_last_one_of_the_same_configuration_counts(client: Any, tmp_path: Path) -> None:
    first = logged(client, tmp_path, started=1)
    other = logged(client, tmp_path, started=2, summary=summary("b"))
    logged(client, tmp_path, started=3, summary=summary("a", "weekly"))
    logged(client, tmp_path, "failed", started=4)
    assert len(nights(client)) == 4
    for configuration, expected in (("a", first), ("b", other), ("never run", other)):
        night = last_night(client, summary(configuration))
        assert night is not None
        assert night.run_id == expected
        pd.testing.assert_frame_equal(night.rows, ROWS)
    assert last_night(client, summary("a", "unknown")) is None
    assert last_night(client, summary("a") | {"format": FORMAT + 1}) is None


def test_nights_are_a_curve_in_one_run(client: Any, tmp_path: Path) -> None:
    for started in (1, 2, 3):
        logged(client, tmp_path, started=started)
    logged(client, tmp_path, started=4, summary=summary("a", "weekly"))
    logged(client, tmp_path, "failed", started=5)
    runs = client.search_runs([client.get_experiment_by_name("history").experiment_id])
    assert {run.info.run_name for run in runs} == {"nightly · nights", "weekly · nights"}
    (nightly,) = [run for run in runs if run.data.tags["campaign"] == "nightly"]
    curve = client.get_metric_history(nightly.info.run_id, "finger/test/rmse_mm")
    assert [(point.step, point.value) for point in curve] == [(1, 1.5), (2, 1.5), (3, 1.5)]
    assert nightly.data.metrics["night"] == 3


def test_a_failed_night_is_marked_in_the_store(client: Any, tmp_path: Path) -> None:
    assert client.get_run(logged(client, tmp_path, "failed")).info.status == "FAILED"


def test_what_a_killed_campaign_left_half_logged_is_removed(client: Any, tmp_path: Path) -> None:
    """By the next one, which holds a lock of the store: on a server another folder may be logging its own."""
    experiment = experiment_of(client, "campaigns")
    half = client.create_run(experiment, tags={"kind": "night", "campaign": "weekly"}).info.run_id
    whole = logged(client, tmp_path)
    assert [run.info.run_id for run in nights(client)] == [whole]
    assert client.get_run(half).info.lifecycle_stage == "deleted"
    assert (tmp_path / "mlflow.db.campaigns.lock").exists()
    everything = client.search_runs([one.experiment_id for one in client.search_experiments()])
    assert {run.info.status for run in everything} == {"FINISHED"}
    assert len(everything) == 2


def test_a_candidate_becomes_champion_for_a_reason_and_is_judged_once(client: Any, tmp_path: Path) -> None:
    client.create_registered_model(NAME)
    for version in ("1", "2"):
        client.create_model_version(NAME, "file:///none")
        nominate(client, NAME, version)
    assert candidates(client, ["finger", "unknown"]) == [Candidate("finger", NAME, "2", "1", None)]
    first, second = (logged(client, tmp_path, started=at) for at in (1, 2))
    move_champions(client, {}, ["finger"], first)
    assert aliases_of(client, NAME)["champion"] == "1"
    move_champions(client, {candidates(client, ["finger"])[0]: "nothing is worse"}, ["finger"], second)
    assert aliases_of(client, NAME)["champion"] == "2"
    assert client.get_model_version(NAME, "2").tags == {REASON: "nothing is worse", JUDGED_IN: second}
    assert candidates(client, ["finger"]) == []
    move_champions(client, {}, ["finger"], first)
    assert client.get_model_version(NAME, "2").tags[JUDGED_IN] == second
