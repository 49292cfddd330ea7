from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from softkin.files import write_json
from softkin.interface import SUBSETS
from softkin.scoring import score


def test_a_known_offset_is_scored_in_every_subset(table: Path, tmp_path: Path) -> None:
    predictions = pd.read_parquet(table).drop(columns=["u1", "u2"])
    predictions[["m1_x", "m1_y", "m1_z"]] += [3.0, 0.0, 4.0]
    predictions.to_parquet(tmp_path / "predictions.parquet")
    write_json(tmp_path / "fit.json", {"fit_seconds": 1.5})
    write_json(tmp_path / "predict.json", {"predict_us_per_row": 2.5})
    names = {"predictions": "predictions.parquet", "fit": "fit.json", "predict": "predict.json"}
    files = {name: str(tmp_path / file) for name, file in names.items()}
    point, markers = tmp_path / "point.csv", tmp_path / "markers.csv"
    score(table, dataset="arm", runs={("lr", "paper"): files}, point=point, markers=markers)
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
