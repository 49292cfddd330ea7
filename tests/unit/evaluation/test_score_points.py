from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from softkin.core.files import write_json
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS
from softkin.evaluation.score_points import score_points, score_spaces


def test_a_known_offset_is_scored_in_every_subset(table: Path, tmp_path: Path) -> None:
    predictions = pd.read_parquet(table).drop(columns=["u1", "u2"])
    predictions[["m1_x", "m1_y", "m1_z"]] += [3.0, 0.0, 4.0]
    predictions.to_parquet(tmp_path / "predictions.parquet")
    write_json(tmp_path / "fit.json", {"fit_seconds": 1.5, "predict_us_per_row": 2.5})
    run, point, markers = Run("lr", "paper"), tmp_path / "point.csv", tmp_path / "markers.csv"
    files = {"predictions": {run: tmp_path / "predictions.parquet"}, "records": {run: tmp_path / "fit.json"}}
    score_points(table, dataset="arm", **files, point=point, markers=markers)
    rows = pd.read_csv(point)
    assert rows["subset"].tolist() == list(SUBSETS)
    assert rows["rmse_mm"].tolist() == pytest.approx([7 / 3] * 4)
    assert rows["euclidean_mean_mm"].tolist() == pytest.approx([5.0] * 4)
    assert set(rows["fit_seconds"]) == {1.5}
    assert set(rows["predict_us_per_row"]) == {2.5}
    first = "dataset,subset,model,preset,rmse_mm,mae_mm,r2,mape_percent,rmse_informative_mm,mae_informative_mm"
    assert point.read_text().startswith(first)
    assert {"r2_informative", "euclidean_p95_mm"} <= set(rows)
    assert pd.read_csv(markers)["euclidean_p95_mm"].tolist() == pytest.approx([5.0] * 4)


def test_either_target_space_is_scored_and_a_model_without_another_is_left_out(table: Path, tmp_path: Path) -> None:
    truth = pd.read_parquet(table).drop(columns=["u1", "u2"])
    coordinates = ["m1_x", "m1_y", "m1_z"]
    chosen = truth.assign(**{name: truth[name] + 1.0 for name in coordinates})
    chosen.to_parquet(tmp_path / "chosen.parquet")
    other = truth.assign(**{name: truth[name] + 2.0 for name in coordinates}, model="gp", target_space="cartesian")
    other[other["subset"].isin(("test", "extrapolation"))].to_parquet(tmp_path / "others.parquet")
    best = {"target_space": "curvature", "shell_mae_mm": 0.5}
    write_json(tmp_path / "gp.json", best | {"other_space": {"target_space": "cartesian", "shell_mae_mm": 0.75}})
    write_json(tmp_path / "lr.json", best | {"other_space": None})
    score_spaces(
        table,
        dataset="arm",
        parameters={model: tmp_path / f"{model}.json" for model in ("lr", "gp")},
        chosen=dict.fromkeys(("lr", "gp"), tmp_path / "chosen.parquet"),
        others=tmp_path / "others.parquet",
        output=tmp_path / "spaces.csv",
    )
    rows = pd.read_csv(tmp_path / "spaces.csv").set_index(["model", "target_space", "subset"])
    assert len(rows) == 4
    for space, error, is_chosen, score_on_train in (("curvature", 1.0, True, 0.5), ("cartesian", 2.0, False, 0.75)):
        for subset in ("test", "extrapolation"):
            row = rows.loc[("gp", space, subset)]
            assert (row["rmse_mm"], row["mae_mm"]) == pytest.approx((error, error))
            assert (row["is_chosen"], row["shell_mae_mm"]) == (is_chosen, score_on_train)
    score_spaces(table, dataset="arm", parameters={}, chosen={}, others=None, output=tmp_path / "spaces.csv")
    assert len(pd.read_csv(tmp_path / "spaces.csv")) == 0
