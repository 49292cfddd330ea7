"""Score with a single row, or a single coordinate, left out: which numbers of a dataset hang on it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.bounds import read_bounds
from softkin.core.csv_tables import write_csv
from softkin.core.metrics.interval import covered, widths, winkler_scores
from softkin.core.metrics.left_out import (
    point_metrics_without_each_row,
    r2_without_each_coordinate,
    without_each_row,
)
from softkin.core.metrics.point import paper_metrics, point_metrics
from softkin.core.runs import Run, nearest_level
from softkin.core.samples import (
    EXTRAPOLATION,
    TEST,
    TRAIN,
    Array,
    coordinate_columns,
    informative_coordinates,
    measured_coordinates,
)
from softkin.data.table import read_subset
from softkin.training.predict import predicted_rows

COLUMNS = ["dataset", "subset", "left_out", "model", "preset", "interval_method", "metric", "value", "without"]
#: A row that moves no number by more than this share of it is not listed.
SMALLEST_CHANGE = 0.01
#: (key of the number, value, its values without each row)
Numbers = list[tuple[dict[str, str], float, Array]]


def score_left_out(
    table: str | Path,
    *,
    dataset: str,
    predictions: Mapping[Run, str | Path],
    intervals: Mapping[str, str | Path],
    shown: Collection[Run],
    confidence_levels: list[float],
    output: str | Path,
) -> None:
    """Write a row (CSV, `COLUMNS`) per number and row or coordinate left out, on test and extrapolation.

    Left out are the rows that move some number most (RMSE, MAE and mean Euclidean error of a run; Winkler score of an
    interval), each out of all numbers, so that two of them can be compared on the same rows; and each coordinate out of
    R2. `left_out` is 'row 17', its place in the subset counted from 0 as in the data card, or 'm2_x'.

    Parameters:
        table: the tidy table.
        dataset: its name.
        predictions: run -> file of its predictions.
        intervals: method -> file of its intervals.
        shown: the runs whose intervals are scored.
        confidence_levels: nominal levels; the one nearest to the paper's is scored.
        output: the scores (CSV).
    """
    truth = {subset: read_subset(table, subset).positions for subset in (TRAIN, TEST, EXTRAPOLATION)}
    moving, level = informative_coordinates(truth[TRAIN]), nearest_level(confidence_levels)
    predicted = {run: pd.read_parquet(path) for run, path in predictions.items()}
    of_level = [("confidence_level", "==", level)]
    bounds = {name: _of_runs(pd.read_parquet(path, filters=of_level), shown) for name, path in intervals.items()}
    rows: list[dict[str, Any]] = []
    for subset in (TEST, EXTRAPOLATION):
        true, key = truth[subset], {"dataset": dataset, "subset": subset}
        numbers: Numbers = []
        for run, frame in predicted.items():
            positions = predicted_rows(frame, [subset])
            numbers += _points(run, true, positions, moving)
            rows += [key | row for row in _coordinates(run, true, positions)]
        for name, of_runs in bounds.items():
            for run, frame in of_runs.items():
                of_subset = read_bounds(frame, subset, [level])[0][:, moving]
                numbers += _intervals(run, name, true[:, moving], of_subset, level)
        rows += [key | row for row in _rows(numbers)]
    write_csv(output, pd.DataFrame(rows, columns=COLUMNS))


def _of_runs(stored: pd.DataFrame, shown: Collection[Run]) -> dict[Run, pd.DataFrame]:
    groups = stored.groupby(["model", "preset"], sort=False)
    return {Run(*run): frame for run, frame in groups if run in shown}


def _points(run: Run, true: Array, predicted: Array, moving: NDArray[np.bool_]) -> Numbers:
    whole = point_metrics(true, predicted, moving)
    without = point_metrics_without_each_row(true, predicted, moving)
    return [
        ({"model": run.model, "preset": run.preset, "interval_method": "", "metric": name}, whole[name], values)
        for name, values in without.items()
    ]


def _intervals(run: Run, method: str, true: Array, bounds: Array, level: float) -> Numbers:
    """Coverage, width and Winkler score of moving coordinates; none where an interval is infinite."""
    if not np.isfinite(bounds).all():
        return []
    parts = {
        "coverage": covered(true, bounds).astype(np.float64),
        "mean_width_mm": widths(bounds),
        "winkler_mm": winkler_scores(true, bounds, level),
    }
    key = {"model": run.model, "preset": run.preset, "interval_method": method}
    of_rows = {name: part.mean(axis=1) for name, part in parts.items()}
    return [(key | {"metric": name}, float(part.mean()), without_each_row(part)) for name, part in of_rows.items()]


def _rows(numbers: Numbers) -> Iterator[dict[str, Any]]:
    """Each number without each of the rows that move one of them most."""
    changes = [np.abs(without - value) for _, value, without in numbers]
    movers = {
        int(change.argmax())
        for change, (_, value, _) in zip(changes, numbers, strict=True)
        if change.max() > SMALLEST_CHANGE * abs(value)
    }
    for place in sorted(movers):
        for key, value, without in numbers:
            yield {"left_out": f"row {place}", **key, "value": value, "without": float(without[place])}


def _coordinates(run: Run, true: Array, predicted: Array) -> Iterator[dict[str, Any]]:
    """R2 without each coordinate that is measured."""
    measured = measured_coordinates(true)
    without = r2_without_each_coordinate(true[:, measured], predicted[:, measured])
    key = {"model": run.model, "preset": run.preset, "interval_method": "", "metric": "r2"}
    value = paper_metrics(true, predicted)["r2"]
    for name, moved in zip(np.array(coordinate_columns(true.shape[1] // 3))[measured], without, strict=True):
        yield {"left_out": name, **key, "value": value, "without": float(moved)}
