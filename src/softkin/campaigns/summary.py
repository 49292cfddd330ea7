"""Sum up a run of the workflow: what campaigns are compared by, as JSON and as a row for each row that was scored."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.bounds import read_bounds
from softkin.core.csv_tables import read_csv
from softkin.core.files import read_json, replacing, write_json
from softkin.core.metrics.interval import covered, widths
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, Array, coordinate_columns, informative_coordinates
from softkin.core.units import own_unit, unit_of
from softkin.data.table import read_subset
from softkin.reporting.tables.interval_choice import deployed_intervals

#: Of the files: raised by one when what is in them changes. Campaigns of another format are not compared with.
FORMAT = 1
#: The subsets that campaigns are compared on.
SCORED = (TEST, EXTRAPOLATION)
ERRORS = ("rmse_mm", "mae_mm", "euclidean_mean_mm")
INTERVALS = ("coverage", "mean_width_mm", "winkler_mm")
#: Hexadecimal digits that name a row: collisions among a million rows have a chance of 1e-7.
DIGITS = 16
#: Where this machine finds data and keeps its runs is no part of a configuration.
PRIVATE = ("data_mirror", "tracking_uri")


@dataclass(frozen=True, slots=True)
class Layout:
    """Patterns of the paths of result files, with {dataset}, {model}, {preset} and {method}."""

    table: str
    description: str
    data_card: str
    predictions: str
    intervals: str


def summarise(
    config: Mapping[str, Any],
    layout: Layout,
    *,
    point: str | Path,
    intervals: str | Path,
    choice: str | Path,
    output: str | Path,
    rows: str | Path,
) -> None:
    """Write the summary of a run (JSON) and its rows (Parquet).

    The summary has the configuration and its hash, and of each dataset its data, findings, deployed model and interval
    method, and headline metrics (mm, or the dataset's `unit`, and shares in [0, 1]; null where infinite). The rows have
    the columns dataset, subset, row, command (both hashes of numbers), error_mm (mean over markers of the distance to
    the true position), width_mm (mean over moving coordinates), and covered, a digit 0 or 1 for each moving coordinate.

    Parameters:
        config: the configuration of the run, with `sources`.
        layout: where its files are.
        point: point_metrics.csv of all datasets.
        intervals: interval_metrics.csv of all datasets.
        choice: interval_choice.csv of all datasets.
        output: the summary.
        rows: the rows.
    """
    deployed = deployed_intervals(read_csv(choice))
    scores, interval_scores = read_csv(point), read_csv(intervals)
    datasets, frames = {}, []
    for dataset in config["datasets"]:
        chosen = deployed.loc[dataset]
        metrics = _metrics(chosen, scores, interval_scores)
        datasets[dataset] = _data(dataset, layout) | {
            "deployed": {name: str(chosen[name]) for name in ("model", "preset", "interval_method", "outside")},
            "metrics": metrics,
        }
        frames.append(_rows(dataset, chosen, layout))
    kept = {key: value for key, value in config.items() if key not in PRIVATE}
    summary = {
        "format": FORMAT,
        "campaign": config["campaign"],
        "seed": config["seed"],
        "confidence_level": float(deployed["confidence_level"].iloc[0]),
        "configuration_sha256": hashlib.sha256(json.dumps(kept, sort_keys=True).encode()).hexdigest(),
        "configuration": kept,
        "datasets": datasets,
    }
    with replacing(rows) as temporary:
        pd.concat(frames, ignore_index=True).to_parquet(temporary, index=False)
    write_json(output, summary)


def _data(dataset: str, layout: Layout) -> dict[str, Any]:
    """What a dataset is, and what its audit found."""
    described = read_json(layout.description.format(dataset=dataset))
    card = read_json(layout.data_card.format(dataset=dataset))
    kept = ("title", "origin", "sha256", "rows", "n_commands", "n_markers", "constant_coordinates", "content_sha256")
    findings = [{name: one[name] for name in ("code", "severity", "sentence")} for one in card["findings"]]
    units = {"unit_in_file": card["unit_in_file"], **own_unit(unit_of(described))}
    return {name: described[name] for name in kept} | units | {"findings": findings}


def _metrics(chosen: pd.Series, scores: pd.DataFrame, interval_scores: pd.DataFrame) -> dict[str, float | None]:
    """test/rmse_mm, ..., extrapolation/winkler_mm_90: of the deployed model, and of its intervals as it gives them."""
    run = {name: chosen[name] for name in ("dataset", "model", "preset")}
    errors = _where(scores, run).set_index("subset")
    mean = _where(interval_scores, run | {"coordinate": "mean_informative", "interval_method": chosen["outside"]})
    mean = mean[mean["confidence_level"] == chosen["confidence_level"]].set_index("subset")
    percent = f"{100 * chosen['confidence_level']:g}"
    values = {f"{subset}/{name}": errors.loc[subset, name] for subset in SCORED for name in ERRORS}
    values |= {f"{subset}/{name}_{percent}": mean.loc[subset, name] for subset in SCORED for name in INTERVALS}
    return {name: float(value) if np.isfinite(value) else None for name, value in values.items()}


def _where(table: pd.DataFrame, wanted: Mapping[str, Any]) -> pd.DataFrame:
    for column, value in wanted.items():
        table = table[table[column] == value]
    return table


def _rows(dataset: str, chosen: pd.Series, layout: Layout) -> pd.DataFrame:
    """The rows of one dataset, by the deployed model and the intervals that it gives."""
    table = layout.table.format(dataset=dataset)
    informative = informative_coordinates(read_subset(table, TRAIN).positions)
    run = {"model": chosen["model"], "preset": chosen["preset"]}
    predicted = pd.read_parquet(layout.predictions.format(dataset=dataset, **run))
    is_run = [(name, "==", value) for name, value in run.items()]
    bounds = pd.read_parquet(layout.intervals.format(dataset=dataset, method=chosen["outside"]), filters=is_run)
    frames = []
    for subset in SCORED:
        truth = read_subset(table, subset)
        names = coordinate_columns(truth.positions.shape[1] // 3)
        errors = predicted.loc[predicted["subset"] == subset, names].to_numpy() - truth.positions
        interval = read_bounds(bounds, subset, [chosen["confidence_level"]])[0]
        hits = covered(truth.positions, interval)[:, informative]
        columns = {
            "row": _names(np.hstack([truth.commands, truth.positions])),
            "command": _names(truth.commands),
            "error_mm": np.linalg.norm(errors.reshape(len(errors), -1, 3), axis=2).mean(axis=1),
            "width_mm": widths(interval)[:, informative].mean(axis=1),
            "covered": ["".join("01"[int(hit)] for hit in row) for row in hits],
        }
        frames.append(pd.DataFrame({"dataset": dataset, "subset": subset, **columns}))
    return pd.concat(frames, ignore_index=True)


def _names(numbers: Array) -> list[str]:
    """A name for each row of numbers (n_rows, n), equal for equal rows."""
    return [hashlib.sha256(row.tobytes()).hexdigest()[:DIGITS] for row in np.ascontiguousarray(numbers)]
