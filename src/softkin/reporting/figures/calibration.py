"""Calibration curve: coverage on `test` against the confidence level, per interval method."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.runs import Run
from softkin.core.samples import TEST, TRAIN, coordinate_columns, informative_coordinates
from softkin.data.table import read_subset
from softkin.models.spec import PAPERS_RUN
from softkin.reporting.figures.reading import candidates, deployed
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import BLACK, LIGHT, LOOKS, PAGE, heading, legend_below, panels, sample

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

N_COLUMNS = 4
MEAN = "mean_informative"


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, title, guarantee, confidence_level, coverage (mean over the moving
    coordinates), lowest and highest (of a coordinate), band_low and band_high, on `test`.

    The band holds the coverage of one coordinate in 95 of 100 cases, exactly; it is NaN where a method has no
    guarantee. Shown are the deployed model and the paper's, and of the quantile regressors the paper's and the best.
    """
    table = read_csv(results.interval_metrics)
    table = table[(table["subset"] == TEST) & table["interval_method"].isin(list(results.intervals))]
    rows = zip(table["model"], table["preset"], table["interval_method"], strict=True)
    shown = {method: _runs(results, method) for method in results.intervals}
    table = table[[(model, preset) in shown[method] for model, preset, method in rows]]
    key = ["interval_method", "model", "preset", "confidence_level"]
    averages = table[table["coordinate"] == MEAN].set_index(key)
    train = read_subset(results.table, TRAIN).positions
    moving = np.array(coordinate_columns(train.shape[1] // 3))[informative_coordinates(train)]
    by_coordinate = table[table["coordinate"].isin(moving)].groupby(key, sort=False)
    frame = averages[["guarantee", "coverage"]].join(by_coordinate["coverage"].agg(lowest="min", highest="max"))
    exact = by_coordinate[["coverage_low", "coverage_high", "coverage_p_value"]].first()
    band = exact[["coverage_low", "coverage_high"]].where(exact["coverage_p_value"].notna())
    frame = frame.join(band.rename(columns={"coverage_low": "band_low", "coverage_high": "band_high"})).reset_index()
    return frame.assign(title=frame["interval_method"].map(dict(results.method_titles)))


def _runs(results: DatasetResults, method: str) -> list[Run]:
    """The runs around which this method's intervals are shown."""
    best = deployed(results)
    if not results.has_own_regressors[method]:
        return [PAPERS_RUN, *([best.run] if best else [])]
    pairs = candidates(results)
    pairs = pairs[pairs["has_own_regressors"]]
    return [PAPERS_RUN, *map(Run, pairs["model"].head(1), pairs["preset"].head(1))]


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw a panel for each method."""
    methods = list(frame.groupby("title", sort=False))
    n_rows = -(-len(methods) // N_COLUMNS)
    n_columns = min(len(methods), N_COLUMNS)
    figure, axes = panels(n_rows, n_columns, PAGE, 1.2 + 1.8 * n_rows, sharex=True, sharey=True)
    places = [axis for row in axes for axis in row]
    for axis in places[len(methods) :]:
        axis.set_axis_off()
    for axis, (title, rows) in zip(places, methods, strict=False):
        _draw(axis, rows)
        axis.set_title(fill(str(title), 20), fontsize=8.5)
    for axis in places[max(0, len(methods) - n_columns) : len(methods)]:
        axis.tick_params(labelbottom=True)
        axis.set_xlabel("confidence level")
    levels = sorted(frame["confidence_level"].unique())
    places[0].set_xticks(levels, [f"{level:.0%}" for level in levels])
    for row in axes:
        row[0].set_ylabel("coverage on test")
    samples = [
        sample(
            f"{results.model_titles[str(model)]}, {preset}",
            color=LOOKS[str(model)][0],
            marker=LOOKS[str(model)][1],
            markersize=5,
            linestyle="--" if (model, preset) == PAPERS_RUN else "-",
        )
        for model, preset in dict.fromkeys(zip(frame["model"], frame["preset"], strict=True))
    ]
    samples.append(sample("nominal level", color=BLACK, linewidth=0.8, linestyle=":"))
    samples.append(sample("exact 95% range of one coordinate", color=LIGHT, linewidth=6))
    legend_below(figure, samples, 3)
    heading(figure, results, "coverage against confidence level")
    return figure


def _draw(axes: Axes, rows: pd.DataFrame) -> None:
    levels = sorted(rows["confidence_level"].unique())
    axes.plot(levels, levels, color=BLACK, linewidth=0.8, linestyle=":")
    runs = list(rows.groupby(["model", "preset"], sort=False))
    band = runs[0][1]
    axes.fill_between(
        band["confidence_level"], band["band_low"], band["band_high"], color=LIGHT, alpha=0.6, linewidth=0
    )
    for place, ((model, preset), part) in enumerate(runs):
        colour, mark = LOOKS[str(model)]
        shifted = part["confidence_level"] + 0.004 * (place - (len(runs) - 1) / 2)
        axes.vlines(shifted, part["lowest"], part["highest"], color=colour, linewidth=1.0)
        line = "--" if (model, preset) == PAPERS_RUN else "-"
        axes.plot(shifted, part["coverage"], color=colour, marker=mark, markersize=4, linewidth=1.0, linestyle=line)


FIGURE = FigureSpec(
    "calibration",
    "Calibration of intervals",
    "Share of test rows whose interval holds the true position, against the confidence level: mean over the moving "
    "coordinates (marks) and range of the single coordinates (bars). A good method follows the dotted line, its bars "
    "within the grey band, which holds the coverage of one coordinate in 95 of 100 cases. Below the line intervals are "
    "too narrow, above it wider than needed. A method without a band has no exact guarantee.",
    frame,
    plot,
)
