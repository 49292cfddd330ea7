from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.campaigns.summary import Layout, summarise
from softkin.core.bounds import bounds_frame
from softkin.core.files import read_json, write_json
from softkin.core.samples import SUBSETS, TEST, Samples, coordinate_columns
from softkin.data.table import to_table, write_table

CONFIG: dict[str, Any] = {"campaign": "nights", "seed": 3, "datasets": ["arm"], "tracking_uri": "sqlite:///a.db"}
CHOSEN = {"dataset": "arm", "model": "gp", "preset": "tuned"}


@pytest.fixture
def results(tmp_path: Path) -> dict[str, Any]:
    """A robot of one marker that stays in a plane: predictions are off by (3, 4, 0) mm, intervals miss x and hold y."""
    rng = np.random.default_rng(0)
    samples = {}
    for subset in SUBSETS:
        positions = rng.uniform(-50, 50, size=(12, 3))
        positions[:, 2] = 7.0
        samples[subset] = Samples(rng.uniform(size=(12, 2)), positions)
    write_table(to_table(samples), tmp_path / "table.parquet")
    predicted = pd.concat(
        pd.DataFrame(rows.positions + np.array([3, 4, 0]), columns=coordinate_columns(1)).assign(subset=subset)
        for subset, rows in samples.items()
    )
    predicted.to_parquet(tmp_path / "gp_tuned.parquet")
    frames = []
    for model in ("gp", "lr"):
        for subset in (TEST, "extrapolation"):
            centre = samples[subset].positions + np.array([5, 0, 0])
            half = np.array([1, 2, 0])
            bounds = np.stack([centre - half, centre + half], axis=-1) * (1 if model == "gp" else 9)
            frames.append(bounds_frame(bounds, subset, 0.9).assign(model=model, preset="tuned"))
    pd.concat(frames).to_parquet(tmp_path / "auto.parquet")
    description = {"title": "Arm", "origin": "own", "sha256": "ab", "rows": dict.fromkeys(SUBSETS, 12), "n_commands": 2}
    description |= {"n_markers": 1, "constant_coordinates": ["m1_z"], "content_sha256": dict.fromkeys(SUBSETS, "c")}
    write_json(tmp_path / "dataset.json", description)
    finding = {"code": "gross", "severity": "note", "sentence": "A row.", "consequence": "None.", "rows": {}}
    write_json(tmp_path / "data_card.json", {"unit_in_file": "mm", "findings": [finding]})
    scores = {"rmse_mm": 1.0, "mae_mm": 2.0, "euclidean_mean_mm": 3.0}
    pd.DataFrame([CHOSEN | {"subset": subset} | scores for subset in SUBSETS]).to_csv(
        tmp_path / "point.csv", index=False
    )
    values = {"coverage": 0.5, "mean_width_mm": np.inf, "winkler_mm": 9.0, "confidence_level": 0.9}
    rows = [
        CHOSEN | {"subset": subset, "coordinate": coordinate, "interval_method": method} | values
        for subset in (TEST, "extrapolation")
        for coordinate in ("m1_x", "mean_informative")
        for method in ("auto", "scp_mapie")
    ]
    pd.DataFrame(rows).to_csv(tmp_path / "intervals.csv", index=False)
    methods = {"interval_method": "scp_mapie", "outside": "auto", "confidence_level": 0.9}
    pd.DataFrame([CHOSEN | methods | {"chosen": True, "deployed": True}]).to_csv(tmp_path / "choice.csv", index=False)
    layout = Layout(
        table=f"{tmp_path}/table.parquet",
        description=f"{tmp_path}/dataset.json",
        data_card=f"{tmp_path}/data_card.json",
        predictions=f"{tmp_path}/{{model}}_{{preset}}.parquet",
        intervals=f"{tmp_path}/{{method}}.parquet",
    )
    files = {name: tmp_path / f"{name}.csv" for name in ("point", "intervals", "choice")}
    return {"layout": layout, "output": tmp_path / "summary.json", "rows": tmp_path / "rows.parquet", **files}


def test_rows_have_errors_widths_and_hits_of_the_deployed_model(results: dict[str, Any]) -> None:
    summarise(CONFIG, **results)
    rows = pd.read_parquet(results["rows"])
    assert len(rows) == 24
    np.testing.assert_allclose(rows["error_mm"], 5.0)
    np.testing.assert_allclose(rows["width_mm"], 3.0)  # of x and y; z does not move
    assert set(rows["covered"]) == {"01"}
    assert rows["row"].is_unique
    assert rows["command"].is_unique


def test_the_summary_has_what_campaigns_are_compared_by(results: dict[str, Any]) -> None:
    summarise(CONFIG, **results)
    summary = read_json(results["output"])
    data = summary["datasets"]["arm"]
    assert data["deployed"] == {"model": "gp", "preset": "tuned", "interval_method": "scp_mapie", "outside": "auto"}
    assert data["metrics"]["test/rmse_mm"] == 1.0
    assert data["metrics"]["extrapolation/coverage_90"] == 0.5
    assert data["metrics"]["test/mean_width_mm_90"] is None  # JSON has no infinity
    assert data["findings"] == [{"code": "gross", "severity": "note", "sentence": "A row."}]
    assert "tracking_uri" not in summary["configuration"]


@pytest.mark.parametrize(("more", "same"), [({"tracking_uri": "http://b"}, True), ({"seed": 4}, False)])
def test_where_runs_are_kept_is_no_part_of_the_configuration(
    results: dict[str, Any], more: dict[str, Any], same: bool
) -> None:
    sums = []
    for config in (CONFIG, CONFIG | more):
        summarise(config, **results)
        sums.append(read_json(results["output"])["configuration_sha256"])
    assert (sums[0] == sums[1]) is same
