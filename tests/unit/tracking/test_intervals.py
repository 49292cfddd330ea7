"""Against a real MLflow store in a temporary folder."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd

from softkin.tracking.intervals import log_intervals
from softkin.tracking.models import log_dataset
from softkin.tracking.store import PARENT, Campaign
from tests.unit.tracking.conftest import client_of_store, snapshot


def test_interval_runs_hang_on_their_model_and_are_logged_once(
    campaign: Campaign, results: dict[str, Any], interval_files: dict[str, Path]
) -> None:
    logged = log_dataset(campaign, **results)
    assert (
        log_intervals(
            campaign,
            **interval_files,
            parents=logged,
        )
        == 2
    )
    before = snapshot(campaign)
    nested = [run for run in before.values() if run["data"]["tags"].get("interval_method") == "scp_mapie"]
    assert [run["data"]["tags"][PARENT] for run in nested] == [logged["svr/tuned"]]
    assert nested[0]["data"]["tags"]["leak"] == "true"
    assert nested[0]["data"]["tags"]["origin"] == "published"
    assert nested[0]["data"]["metrics"]["test/coverage_90"] == 0.91
    assert nested[0]["data"]["metrics"]["extrapolation/joint_coverage_90"] == 0.91
    assert "test/joint_winkler_mm_90" not in nested[0]["data"]["metrics"]
    client = client_of_store(campaign)
    pictures = client.list_artifacts(nested[0]["info"]["run_id"], "figures")
    assert [picture.path for picture in pictures] == ["figures/intervals_deployed.png"]
    log_intervals(
        campaign,
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


def test_interval_runs_follow_a_superseded_model_and_retire_with_their_method(
    campaign: Campaign, results: dict[str, Any], interval_files: dict[str, Path]
) -> None:
    first = log_dataset(campaign, **results)
    log_intervals(campaign, **interval_files, parents=first)
    Path(results["runs"]["svr", "tuned"]["predictions"]).write_text("moved")
    second = log_dataset(campaign, **results)
    table = pd.read_csv(interval_files["metrics"])
    table[table["interval_method"] == "qr"].to_csv(interval_files["metrics"], index=False)
    assert (
        log_intervals(
            campaign,
            **interval_files,
            parents=second,
        )
        == 1
    )
    nested = [run for run in snapshot(campaign).values() if "interval_method" in run["data"]["tags"]]
    assert [run["data"]["tags"][PARENT] for run in nested] == [second["svr/tuned"]]
