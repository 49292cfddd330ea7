"""Make the tables of a run once more from its stored predictions and intervals, and say what differs."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.cli.differences import differ, differences
from softkin.cli.rebuild import can_be_rebuilt, rebuilt
from softkin.core.bounds import read_bounds
from softkin.core.csv_tables import read_csv
from softkin.core.errors import SoftkinError
from softkin.core.escaping import one_line
from softkin.core.metrics.interval import covered, widths, winkler_scores
from softkin.core.runs import Run
from softkin.core.samples import EXTRAPOLATION, TEST, Array, coordinate_columns
from softkin.data.table import read_subset
from softkin.evaluation.score_points import score_points

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
KEY = ["interval_method", "model", "preset", "subset", "confidence_level"]
SCORES = ["coverage", "mean_width_mm", "winkler_mm"]


def recomputed(results: Path) -> Iterator[str]:
    """What differs between the tables below `results` and what its stored predictions give, a sentence each."""
    datasets = [path.parent for path in sorted(results.glob("*/point_metrics.csv")) if path.parent.name != "tables"]
    for dataset in datasets:
        yield from _readable(points, dataset)
        yield from _readable(intervals, dataset)
    if can_be_rebuilt(results):
        yield from _readable(rebuilt, results)
        return
    for name in COLLECTED:
        yield from _readable(collected, results / "tables" / f"{name}.csv", datasets)


def _readable(check: Callable[..., list[str]], path: Path, *more: Any) -> list[str]:
    try:
        return check(path, *more)
    except (SoftkinError, OSError, ValueError, KeyError, TypeError) as error:
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
    truth = {subset: read_subset(folder / "table.parquet", subset).positions for subset in (TEST, EXTRAPOLATION)}
    parts = [_scores(file, truth) for file in sorted((folder / "intervals").glob("*.parquet"))]
    if not parts:
        return []
    key = [*KEY, "coordinate"]
    both = pd.concat(parts, ignore_index=True).merge(metrics[[*key, *SCORES]], "left", key, suffixes=("_made", ""))
    is_wrong = np.any([differ(both[name], both[f"{name}_made"]) for name in SCORES], axis=0)
    wrong = [
        f"{row.interval_method} around {row.model} {row.preset}, {row.subset}, {row.coordinate}, "
        f"{row.confidence_level:g}"
        for row in both[is_wrong].itertuples()
    ]
    more = f" and {len(wrong) - 1} more rows" if len(wrong) > 1 else ""
    return [f"{path} is not what the stored intervals give: {wrong[0]}{more}"] if wrong else []


def _scores(file: Path, truth: Mapping[str, Array]) -> pd.DataFrame:
    """Mean scores of the intervals in a file: a row per run, subset, level and coordinate.

    Raises:
        ValueError: a run has not an interval for each true position.
    """
    stored, parts = pd.read_parquet(file), []
    for (subset, level), rows in stored[stored["subset"].isin(truth)].groupby(["subset", "confidence_level"]):
        true = truth[str(subset)]
        of_runs = rows.groupby(["model", "preset"], sort=False)
        runs = of_runs.size()
        if (runs != len(true)).any():
            raise ValueError(f"{file} has not an interval for each row of {subset}")
        ordered = rows.iloc[np.argsort(of_runs.ngroup().to_numpy(), kind="stable")]
        bounds = read_bounds(ordered, str(subset), [float(level)])[0]
        repeated = np.tile(true, (len(runs), 1))
        scores = (
            covered(repeated, bounds),
            widths(bounds),
            winkler_scores(repeated, bounds, float(level)),
        )
        means = (score.reshape(len(runs), *true.shape).mean(axis=1).ravel() for score in scores)
        names = coordinate_columns(true.shape[1] // 3)
        key = [(file.stem, *run, subset, level, name) for run in runs.index for name in names]
        frame = pd.DataFrame(key, columns=[*KEY, "coordinate"])
        parts.append(frame.assign(**dict(zip(SCORES, means, strict=True))))
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=[*KEY, "coordinate", *SCORES])


def collected(table: Path, datasets: Sequence[Path]) -> list[str]:
    """What differs between a `table` across `datasets` and the files that its rows were collected from."""
    if not table.is_file():
        return []
    listed = list(dict.fromkeys(read_csv(table)["dataset"]))
    made = [read_csv(folder / table.name) for name in listed for folder in datasets if folder.name == name]
    return differences(table, pd.concat(made, ignore_index=True)) if made else []
