"""Conditional coverage: coverage on `test` by marker, command, position and width."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.bounds import read_bounds
from softkin.core.csv_tables import write_csv
from softkin.core.metrics.interval import covered, widths, worst_slab
from softkin.core.runs import Run, nearest_level
from softkin.core.samples import TEST, TRAIN, VALIDATION, Array, Samples, informative_coordinates
from softkin.data.table import read_subset
from softkin.evaluation.small_regions import deployed_rows
from softkin.uncertainty.calibrated_model import CalibratedModel

N_BINS = 5
#: Memory of MAPIE's HSIC grows with the square of the rows.
HSIC_ROWS = 2000


def conditional_coverage(
    table: str | Path,
    *,
    dataset: str,
    intervals: Mapping[str, str | Path],
    shown: Collection[Run],
    confidence_levels: list[float],
    seed: int,
    output: str | Path,
    robot: CalibratedModel | None = None,
) -> None:
    """Write a row per run, method, `by` and group: share of covered coordinates and its standard error.

    `by` is marker, command_norm, predicted_position (distance from the mean pose of `train`), width (MAPIE's
    size-stratified coverage), slab (that of lowest coverage, with a fifth of the rows, searched on one half
    of the rows and measured on the other) or hsic (MAPIE's dependence of coverage on width; 0 is none). Of the
    intervals that the calibrated model gives there are rows by small_region and by failure, see `deployed_rows`.

    Parameters:
        table: the tidy table.
        dataset: its name.
        intervals: method -> file of its intervals.
        shown: the runs that get rows.
        confidence_levels: nominal levels; the one nearest to the paper's is evaluated.
        seed: of the halves and directions of the slabs.
        output: the coverages (CSV).
        robot: the calibrated model; None: no rows on the intervals that it gives.
    """
    level = nearest_level(confidence_levels)
    test, train = read_subset(table, TEST), read_subset(table, TRAIN)
    moving = informative_coordinates(train.positions)
    rows: list[dict[str, Any]] = []
    for method, path in intervals.items():
        stored = pd.read_parquet(path, filters=[("subset", "==", TEST), ("confidence_level", "==", level)])
        for (model, preset), of_run in stored.groupby(["model", "preset"], sort=False):
            if (model, preset) not in shown:
                continue
            bounds = read_bounds(of_run, TEST, [level])[0][:, moving]
            key = {"dataset": dataset, "model": model, "preset": preset, "interval_method": method}
            key |= {"confidence_level": level}
            rows += [key | row for row in _groups(test, train, bounds, moving, seed)]
    if robot is not None:
        key = {"dataset": dataset, "model": robot.spec.name, "preset": robot.preset}
        key |= {"interval_method": robot.method.name, "confidence_level": level}
        rows += [key | row for row in deployed_rows(robot, read_subset(table, VALIDATION), test, level)]
    write_csv(output, pd.DataFrame(rows))


def _groups(
    test: Samples, train: Samples, bounds: Array, moving: NDArray[np.bool_], seed: int
) -> Iterator[dict[str, Any]]:
    """A row per group of all kinds, of the moving coordinates' bounds (n_rows, n_moving, 2) of one run."""
    is_covered = covered(test.positions[:, moving], bounds)
    markers = np.flatnonzero(moving) // 3
    for marker in np.unique(markers):
        yield {"by": "marker", "group": f"m{marker + 1}", **_share(is_covered[:, markers == marker])}
    centre = np.where(np.isfinite(bounds).all(axis=-1, keepdims=True), bounds, 0.0).mean(axis=-1)
    variables = {
        "command_norm": np.linalg.norm(test.commands, axis=1),
        "predicted_position": np.linalg.norm(centre - train.positions[:, moving].mean(axis=0), axis=1),
    }
    for by, values in variables.items():
        for place, rows in enumerate(np.array_split(np.argsort(values, kind="stable"), N_BINS)):
            limits = {"low": values[rows].min(), "high": values[rows].max()}
            yield {"by": by, "group": str(place + 1), **limits, **_share(is_covered[rows])}
    yield from _by_width(test.positions[:, moving], bounds, is_covered)
    rows = worst_slab(test.commands, is_covered.mean(axis=1), seed)
    if len(rows):
        yield {"by": "slab", "group": "worst", **_share(is_covered[rows])}


def _by_width(true: Array, bounds: Array, is_covered: NDArray[np.bool_]) -> Iterator[dict[str, Any]]:
    """Rows by width, for intervals whose width differs from row to row in every coordinate."""
    from mapie.metrics.regression import hsic, regression_ssc

    width = widths(bounds)
    if not np.isfinite(width).all():
        return
    # In units of the mean width of each coordinate: MAPIE rounds widths, and those of some robots are nanometres.
    scale = np.maximum(width.mean(axis=0), np.finfo(float).tiny)
    true, bounds = true / scale, bounds / scale[:, None]
    if min(len(np.unique(column.round(5))) for column in widths(bounds).T) <= N_BINS:
        return
    strata = [regression_ssc(column, bounds[:, i, :, None], num_bins=N_BINS)[0] for i, column in enumerate(true.T)]
    order = np.argsort(width.mean(axis=1), kind="stable")
    for place, (coverage, rows) in enumerate(zip(np.mean(strata, axis=0), np.array_split(order, N_BINS), strict=True)):
        limits = {"low": width[rows].mean(axis=1).min(), "high": width[rows].mean(axis=1).max()}
        error = _share(is_covered[rows])["standard_error"]
        yield {
            "by": "width",
            "group": str(place + 1),
            **limits,
            "n_rows": len(rows),
            "coverage": coverage,
            "standard_error": error,
        }
    rows = np.linspace(0, len(true) - 1, min(len(true), HSIC_ROWS)).astype(int)
    dependence = [float(hsic(column[rows], bounds[rows, i, :, None])[0]) for i, column in enumerate(true.T)]
    yield {"by": "hsic", "group": "mean", "n_rows": len(rows), "value": float(np.mean(dependence))}


def _share(is_covered: NDArray[np.bool_]) -> dict[str, Any]:
    """Share of covered coordinates; its standard error treats rows, not coordinates, as independent."""
    by_row = is_covered.mean(axis=1)
    error = by_row.std(ddof=1) / np.sqrt(len(by_row)) if len(by_row) > 1 else float("nan")
    return {"n_rows": len(by_row), "coverage": by_row.mean(), "standard_error": error}
