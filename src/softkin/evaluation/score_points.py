"""Score points: predictions and true positions of one dataset -> its rows of the point-metric tables."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.csv_tables import write_csv
from softkin.core.files import read_json
from softkin.core.metrics.point import euclidean_errors, paper_metrics, point_metrics
from softkin.core.runs import Run
from softkin.core.samples import EXTRAPOLATION, SUBSETS, TEST, TRAIN, coordinate_columns, informative_coordinates
from softkin.data.table import read_subset

SPACE_COLUMNS = ["dataset", "subset", "model", "target_space", "is_chosen", "shell_mae_mm", "rmse_mm", "mae_mm"]


def score_points(
    table: str | Path,
    *,
    dataset: str,
    predictions: Mapping[Run, str | Path],
    records: Mapping[Run, str | Path],
    point: str | Path,
    markers: str | Path,
) -> None:
    """Write the point metrics of all runs.

    Parameters:
        table: the tidy table.
        dataset: its name.
        predictions: run -> file of its predictions (Parquet).
        records: run -> record of its fit (JSON).
        point: output (CSV), a row per subset, model and preset.
        markers: output (CSV), a row per subset, model, preset and marker.
    """
    truth = {subset: read_subset(table, subset).positions for subset in SUBSETS}
    informative = informative_coordinates(truth[TRAIN])
    point_rows: list[dict[str, Any]] = []
    marker_rows: list[dict[str, Any]] = []
    for run, path in predictions.items():
        frame, record = pd.read_parquet(path), read_json(records[run])
        seconds = {name: record[name] for name in ("fit_seconds", "predict_us_per_row")}
        for subset, true in truth.items():
            columns = coordinate_columns(true.shape[1] // 3)
            predicted = frame.loc[frame["subset"] == subset, columns].to_numpy()
            key = {"dataset": dataset, "subset": subset, "model": run.model, "preset": run.preset}
            point_rows.append(key | point_metrics(true, predicted, informative) | seconds)
            errors = euclidean_errors(true, predicted)
            means, p95s = errors.mean(axis=0), np.percentile(errors, 95, axis=0)
            marker_rows += [
                key | {"marker": i + 1, "euclidean_mean_mm": mean, "euclidean_p95_mm": p95}
                for i, (mean, p95) in enumerate(zip(means, p95s, strict=True))
            ]
    for rows, output in ((point_rows, point), (marker_rows, markers)):
        write_csv(output, pd.DataFrame(rows))


def score_spaces(
    table: str | Path,
    *,
    dataset: str,
    parameters: Mapping[str, str | Path],
    chosen: Mapping[str, str | Path],
    others: str | Path | None,
    output: str | Path,
) -> None:
    """Write RMSE and MAE on test and extrapolation of each model in either target space.

    One space is that chosen by the study on outer shells; `shell_mae_mm` is its score there.

    Parameters:
        table: the tidy table.
        dataset: its name.
        parameters: model -> file of the best parameters of its study.
        chosen: model -> file of its predictions in the chosen space.
        others: file of `refit_spaces`, the predictions in the other spaces; None: the output has no rows.
        output: the scores (CSV).
    """
    truth = {subset: read_subset(table, subset).positions for subset in (TEST, EXTRAPOLATION)}
    other_space = pd.DataFrame(columns=["model"]) if others is None else pd.read_parquet(others)
    rows: list[dict[str, Any]] = []
    for model, path in parameters.items():
        best, other = read_json(path), other_space[other_space["model"] == model]
        if other.empty:
            continue
        for in_space, predictions in ((best, pd.read_parquet(chosen[model])), (best["other_space"], other)):
            key = {"dataset": dataset, "model": model, "target_space": in_space["target_space"]}
            key |= {"is_chosen": in_space is best, "shell_mae_mm": in_space["shell_mae_mm"]}
            for subset, true in truth.items():
                columns = coordinate_columns(true.shape[1] // 3)
                predicted = predictions.loc[predictions["subset"] == subset, columns].to_numpy(np.float64)
                scores = paper_metrics(true, predicted)
                errors = {name: scores[name] for name in ("rmse_mm", "mae_mm")}
                rows.append(key | {"subset": subset} | errors)
    write_csv(output, pd.DataFrame(rows, columns=SPACE_COLUMNS))
