"""Score: predictions and truth of one dataset -> its rows of the point-metric tables."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.datasets.table import read_subset
from softkin.files import read_json, replacing
from softkin.interface import SUBSETS, TRAIN, coordinate_columns, informative_coordinates
from softkin.metrics.point import euclidean_errors, point_metrics

#: (model, preset) -> paths of its predictions, fit record and prediction record.
Runs = Mapping[tuple[str, str], Mapping[str, str]]


def score(table: str | Path, *, dataset: str, runs: Runs, point: str | Path, markers: str | Path) -> None:
    """Write `point` (a row per subset, model, preset) and `markers` (a row per subset, model, preset, marker)."""
    truth = {subset: read_subset(table, subset).positions for subset in SUBSETS}
    informative = informative_coordinates(truth[TRAIN])
    point_rows: list[dict[str, Any]] = []
    marker_rows: list[dict[str, Any]] = []
    for (model, preset), files in runs.items():
        predictions = pd.read_parquet(files["predictions"])
        seconds = {
            "fit_seconds": read_json(files["fit"])["fit_seconds"],
            "predict_us_per_row": read_json(files["predict"])["predict_us_per_row"],
        }
        for subset, true in truth.items():
            columns = coordinate_columns(true.shape[1] // 3)
            predicted = predictions.loc[predictions["subset"] == subset, columns].to_numpy()
            key = {"dataset": dataset, "subset": subset, "model": model, "preset": preset}
            point_rows.append(key | point_metrics(true, predicted, informative) | seconds)
            errors = euclidean_errors(true, predicted)
            means, p95s = errors.mean(axis=0), np.percentile(errors, 95, axis=0)
            marker_rows += [
                key | {"marker": i + 1, "euclidean_mean_mm": mean, "euclidean_p95_mm": p95}
                for i, (mean, p95) in enumerate(zip(means, p95s, strict=True))
            ]
    for rows, path in ((point_rows, point), (marker_rows, markers)):
        with replacing(path) as temporary:
            pd.DataFrame(rows).to_csv(temporary, index=False)
