"""Interval width against error of each row of `test`, per method: whether wide intervals mark bad predictions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from softkin.core.runs import Run
from softkin.core.samples import TEST
from softkin.data.table import read_subset
from softkin.reporting.figures.reading import bounds, candidates, shown_coordinate
from softkin.reporting.figures.sampling import drawn_rows
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import (
    BLACK,
    BLUE,
    GREY,
    LEAST_MM,
    PAGE,
    VERMILION,
    heading,
    legend_below,
    logarithmic,
    panels,
    sample,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

N_METHODS = 4
N_PARTS = 5


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, title, coordinate, confidence_level, half_width_mm, error_mm, covered.

    A row per drawn row of `test`, of the coordinate that moves furthest on `train`, for the chosen interval and the
    three next best candidates whose width is not the same on every row; rows without a finite interval are left out.
    `error_mm` is the distance of the true position from the interval's middle.
    """
    coordinate, name = shown_coordinate(results)
    true = read_subset(results.table, TEST).positions[:, coordinate]
    rows = drawn_rows(len(true))
    true = true[rows]
    parts: list[pd.DataFrame] = []
    for row in candidates(results).itertuples():
        intervals = bounds(results, row.interval_method, Run(row.model, row.preset), row.confidence_level, [name])
        assert intervals is not None  # a candidate has intervals
        lower, upper = intervals[rows, 0].T
        finite = np.isfinite(upper - lower)
        lower, upper, inner = lower[finite], upper[finite], true[finite]
        part = pd.DataFrame({"half_width_mm": (upper - lower) / 2, "error_mm": np.abs(inner - (lower + upper) / 2)})
        part["covered"] = (lower <= inner) & (inner <= upper)
        if part.empty or (parts and _is_constant(part)):
            continue
        key = {"model": row.model, "preset": row.preset, "interval_method": row.interval_method}
        title = f"{results.method_titles[row.interval_method]}\n{row.model} {row.preset}"
        parts.append(part.assign(**key, title=title, coordinate=name, confidence_level=row.confidence_level))
        if len(parts) == N_METHODS:
            break
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def _is_constant(part: pd.DataFrame) -> bool:
    return bool(np.ptp(part["half_width_mm"]) <= 1e-6 * part["half_width_mm"].max())


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw a log-log panel for each method."""
    frame = frame.assign(**frame[["half_width_mm", "error_mm"]].clip(lower=LEAST_MM))
    groups = list(frame.groupby("title", sort=False))
    figure, axes = panels(1, len(groups), PAGE, 3.2, sharex=True, sharey=True)
    for axis, (title, rows) in zip(axes[0], groups, strict=True):
        _draw(axis, rows)
        axis.set_title(str(title), fontsize=8)
        axis.set_xlabel(f"half width ({results.unit})")
    logarithmic(axes[0][0].xaxis, 4)
    logarithmic(axes[0][0].yaxis)
    axes[0][0].set_ylabel(f"distance of the true position\nfrom the interval's middle ({results.unit})")
    level = frame["confidence_level"].iloc[0]
    samples = [
        sample("covered", color=BLUE, marker=".", linestyle=""),
        sample("missed", color=VERMILION, marker=".", linestyle=""),
        sample("edge of the interval", color=GREY, linewidth=0.8, linestyle="--"),
        sample(f"{level:.0%} quantile of rows of like width", color=BLACK, marker="o", markersize=4, linewidth=1.2),
    ]
    legend_below(figure, samples, 4)
    heading(figure, results, f"{level:.0%} intervals of {frame['coordinate'].iloc[0]}, width and error", rows_of=[TEST])
    return figure


def _draw(axes: Axes, rows: pd.DataFrame) -> None:
    level = rows["confidence_level"].iloc[0]
    for is_covered, colour in ((True, BLUE), (False, VERMILION)):
        part = rows[rows["covered"] == is_covered]
        axes.loglog(part["half_width_mm"], part["error_mm"], ".", color=colour, markersize=2.5, rasterized=True)
    low, high = rows["half_width_mm"].agg(["min", "max"])
    axes.plot([low, high], [low, high], color=GREY, linewidth=0.8, linestyle="--")
    if _is_constant(rows):
        return
    ordered = rows.sort_values("half_width_mm", kind="stable")
    parts = [ordered.iloc[part] for part in np.array_split(np.arange(len(ordered)), N_PARTS) if len(part)]
    quantiles = [part["error_mm"].quantile(level) for part in parts]
    axes.plot(
        [part["half_width_mm"].median() for part in parts], quantiles, "o-", color=BLACK, markersize=3, linewidth=1.2
    )


FIGURE = FigureSpec(
    "width",
    "Interval width against error",
    "Each dot is a row of test: half the width of its interval against the distance of the true position from the "
    "interval's middle. Dots above the dashed line are missed. The black line of a good method follows the dashed one: "
    "its intervals are wide where errors are large. A flat black line is a method whose width says nothing about the "
    "error; a vertical column of dots is one whose width is the same everywhere.",
    frame,
    plot,
)
