"""Is the coverage there where it matters? Coverage on `test` by marker, command, position and width."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.bounds import read_bounds
from softkin.core.files import replacing
from softkin.core.metrics.interval import covered, widths, worst_slab
from softkin.core.runs import Run
from softkin.core.samples import TEST, TRAIN, Array, Samples, informative_coordinates
from softkin.data.table import read_subset
from softkin.uncertainty.choose import nearest_level

N_BINS = 5
#: MAPIE's HSIC takes the square of the rows in memory.
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
) -> None:
    """Write a row per model, preset, method, `by` and group: share of covered coordinates and its standard error.

    `intervals` is method -> file; only the runs in `shown` and those on quantiles are looked at.
    `by` is marker, command_norm, predicted_position (distance from the mean pose of `train`), width (MAPIE's
    size-stratified coverage), slab (the worst of the command space holding a fifth of the rows, found on one half of
    the rows and measured on the other) or hsic (MAPIE's dependence of coverage on width; 0 is none).
    """
    level = nearest_level(confidence_levels)
    test, train = read_subset(table, TEST), read_subset(table, TRAIN)
    moving = informative_coordinates(train.positions)
    rows: list[dict[str, Any]] = []
    for method, path in intervals.items():
        stored = pd.read_parquet(path)
        for (model, preset), mine in stored.groupby(["model", "preset"], sort=False):
            if (model, preset) not in shown:
                continue
            bounds = read_bounds(mine, TEST, [level])[0][:, moving]
            key = {"dataset": dataset, "model": model, "preset": preset, "interval_method": method}
            key |= {"confidence_level": level}
            rows += [key | row for row in _groups(test, train, bounds, moving, seed)]
    with replacing(output) as temporary:
        pd.DataFrame(rows).to_csv(temporary, index=False)


def _groups(
    test: Samples, train: Samples, bounds: Array, moving: NDArray[np.bool_], seed: int
) -> Iterator[dict[str, Any]]:
    inside = covered(test.positions[:, moving], bounds)
    markers = np.flatnonzero(moving) // 3
    for marker in np.unique(markers):
        yield {"by": "marker", "group": f"m{marker + 1}", **_share(inside[:, markers == marker])}
    centre = np.where(np.isfinite(bounds).all(axis=-1), bounds.mean(axis=-1), 0.0)
    variables = {
        "command_norm": np.linalg.norm(test.commands, axis=1),
        "predicted_position": np.linalg.norm(centre - train.positions[:, moving].mean(axis=0), axis=1),
    }
    for by, values in variables.items():
        for place, rows in enumerate(np.array_split(np.argsort(values, kind="stable"), N_BINS)):
            limits = {"low": values[rows].min(), "high": values[rows].max()}
            yield {"by": by, "group": str(place + 1), **limits, **_share(inside[rows])}
    yield from _by_width(test.positions[:, moving], bounds, inside)
    rows = worst_slab(test.commands, inside.mean(axis=1), seed)
    if len(rows):
        yield {"by": "slab", "group": "worst", **_share(inside[rows])}


def _by_width(true: Array, bounds: Array, inside: NDArray[np.bool_]) -> Iterator[dict[str, Any]]:
    """Only for intervals whose width differs from row to row, in every coordinate."""
    from mapie.metrics.regression import hsic, regression_ssc

    width = widths(bounds)
    if not np.isfinite(width).all():
        return
    # In units of each coordinate's mean width: MAPIE rounds widths, and some robots are known to a nanometre.
    scale = np.maximum(width.mean(axis=0), np.finfo(float).tiny)
    true, bounds = true / scale, bounds / scale[:, None]
    if min(len(np.unique(column.round(5))) for column in widths(bounds).T) <= N_BINS:
        return
    strata = [regression_ssc(column, bounds[:, i, :, None], num_bins=N_BINS)[0] for i, column in enumerate(true.T)]
    order = np.argsort(width.mean(axis=1), kind="stable")
    for place, (coverage, rows) in enumerate(zip(np.mean(strata, axis=0), np.array_split(order, N_BINS), strict=True)):
        limits = {"low": width[rows].mean(axis=1).min(), "high": width[rows].mean(axis=1).max()}
        error = _share(inside[rows])["standard_error"]
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


def _share(inside: NDArray[np.bool_]) -> dict[str, Any]:
    """Share of covered coordinates; its standard error treats rows, not coordinates, as independent."""
    by_row = inside.mean(axis=1)
    error = by_row.std(ddof=1) / np.sqrt(len(by_row)) if len(by_row) > 1 else float("nan")
    return {"n_rows": len(by_row), "coverage": by_row.mean(), "standard_error": error}
