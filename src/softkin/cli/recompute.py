"""Make the tables of a run once more from its stored predictions and intervals, and say what differs."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.bounds import bounds_levels, read_bounds
from softkin.core.csv_tables import read_csv
from softkin.core.escaping import one_line
from softkin.core.metrics.interval import covered, widths, winkler_scores
from softkin.core.runs import Run
from softkin.core.samples import EXTRAPOLATION, TEST, coordinate_columns
from softkin.data.table import read_subset
from softkin.evaluation.score_points import score_points

#: Numbers that differ by less, relative to their size, are the same.
TOLERANCE = 1e-9
#: Tables across datasets that hold the rows of a file of the same name of each dataset.
COLLECTED = (
    "point_metrics",
    "marker_errors",
    "interval_metrics",
    "conditional_coverage",
    "alarm_rates",
    "extrapolation_intervals",
    "target_spaces",
    "left_out",
)
#: What a row of the interval metrics is about.
KEY = ["interval_method", "model", "preset", "subset", "coordinate", "confidence_level"]


def recomputed(results: Path) -> Iterator[str]:
    """What differs between the tables below `results` and what its stored predictions give, a sentence each."""
    datasets = [path.parent for path in sorted(results.glob("*/point_metrics.csv")) if path.parent.name != "tables"]
    for dataset in datasets:
        yield from _readable(points, dataset)
        yield from _readable(intervals, dataset)
    for name in COLLECTED:
        yield from _readable(collected, results / "tables" / f"{name}.csv", datasets)


def _readable(check: Callable[..., list[str]], path: Path, *more: Any) -> list[str]:
    try:
        return check(path, *more)
    except (OSError, ValueError, KeyError, TypeError) as error:
        return [f"{path} cannot be checked: {one_line(str(error))[:200]}"]


def points(folder: Path) -> list[str]:
    """What differs between a dataset's point metrics and those of its stored predictions."""
    stored = read_csv(folder / "point_metrics.csv")
    runs = [Run(*run) for run in stored[["model", "preset"]].drop_duplicates().itertuples(index=False)]
    with tempfile.TemporaryDirectory() as place:
        made = {name: Path(place) / f"{name}.csv" for name in ("point_metrics", "marker_errors")}
        score_points(
            folder / "table.parquet",
            dataset=folder.name,
            predictions={run: folder / run.model / run.preset / "predictions.parquet" for run in runs},
            records={run: folder / run.model / run.preset / "fit.json" for run in runs},
            point=made["point_metrics"],
            markers=made["marker_errors"],
        )
        parts = [differences(folder / f"{name}.csv", read_csv(path)) for name, path in made.items()]
    return [sentence for part in parts for sentence in part]


def intervals(folder: Path) -> list[str]:
    """What differs between a dataset's coverage, widths and Winkler scores and those of its stored intervals."""
    path = folder / "interval_metrics.csv"
    metrics = read_csv(path)
    known = metrics.set_index(KEY)[["coverage", "mean_width_mm", "winkler_mm"]].sort_index()
    wrong = []
    for file in sorted((folder / "intervals").glob("*.parquet")):
        for (model, preset), stored in pd.read_parquet(file).groupby(["model", "preset"], sort=False):
            levels = bounds_levels(stored)
            for subset in (TEST, EXTRAPOLATION):
                true = read_subset(folder / "table.parquet", subset).positions
                for level, bounds in zip(levels, read_bounds(stored, subset, levels), strict=True):
                    parts = covered(true, bounds), widths(bounds), winkler_scores(true, bounds, level)
                    means = np.column_stack([part.mean(axis=0) for part in parts])
                    for name, made in zip(coordinate_columns(true.shape[1] // 3), means, strict=True):
                        key = (file.stem, model, preset, subset, name, level)
                        if key not in known.index or _differ(known.loc[key], made):
                            wrong.append(f"{file.stem} around {model} {preset}, {subset}, {name}, {level:g}")
    more = f" and {len(wrong) - 1} more rows" if len(wrong) > 1 else ""
    return [f"{path} is not what the stored intervals give: {wrong[0]}{more}"] if wrong else []


def collected(table: Path, datasets: Sequence[Path]) -> list[str]:
    """What differs between a `table` across `datasets` and the files that its rows were collected from."""
    if not table.is_file():
        return []
    listed = list(dict.fromkeys(read_csv(table)["dataset"]))
    made = [read_csv(folder / table.name) for name in listed for folder in datasets if folder.name == name]
    return differences(table, pd.concat(made, ignore_index=True)) if made else []


def differences(path: Path, made: pd.DataFrame) -> list[str]:
    """What differs between the table at `path` and what it was `made` from, in the columns of that."""
    stored = read_csv(path)
    if len(stored) != len(made):
        return [f"{path} has {len(stored)} rows, and its sources give {len(made)}"]
    for name in made:
        if name not in stored:
            return [f"{path} has no column {name}"]
        for row, (old, new) in enumerate(zip(stored[name], made[name], strict=True)):
            if _differ([old], [new]):
                return [f"{path}, row {row + 1}, column {name}: {old} stands there, and its sources give {new}"]
    return []


def _differ(old: Any, new: Any) -> bool:
    try:
        numbers = np.ravel(np.asarray(old, dtype=np.float64)), np.ravel(np.asarray(new, dtype=np.float64))
    except (TypeError, ValueError):
        return list(map(str, np.ravel(old))) != list(map(str, np.ravel(new)))
    return not np.allclose(*numbers, rtol=TOLERANCE, atol=0.0, equal_nan=True)
