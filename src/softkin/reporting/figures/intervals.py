"""Intervals of the paper's four methods on `test`, rows sorted by true position (the paper's Figure 6)."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from softkin.core.runs import Run
from softkin.core.samples import TEST, Array
from softkin.data.table import read_subset
from softkin.models.spec import PAPERS_RUN
from softkin.reporting.figures.reading import bounds, candidates, deployed, shown_coordinate
from softkin.reporting.figures.sampling import drawn_rows
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import BLUE, GREY, PAGE, SKY, VERMILION, heading, legend_below, panels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: The paper's four.
METHODS = ("qr", "cqr", "scp_mapie", "scp_crepes")


def frame(results: DatasetResults, *, is_papers: bool) -> pd.DataFrame:
    """Columns model, preset, interval_method, title, coordinate, confidence_level, true, lower, upper (mm), covered.

    A row per row of `test` and method that was run, sorted by true position, of the coordinate that moves furthest on
    `train`. The intervals are around the paper's model or, unless `is_papers`, around the deployed one; QR and CQR
    have quantile regressors of their own: the paper's, in the preset of that model.
    """
    coordinate, name = shown_coordinate(results)
    true = read_subset(results.table, TEST).positions[:, coordinate]
    order = np.argsort(true, kind="stable")
    level = float(candidates(results)["confidence_level"].iloc[0])
    best = deployed(results)
    if best is None and not is_papers:
        return pd.DataFrame()
    model, preset = PAPERS_RUN if is_papers or best is None else best.run
    parts = []
    for method in (method for method in METHODS if method in results.intervals):
        run = Run(PAPERS_RUN.model if results.has_own_regressors[method] else model, preset)
        intervals = bounds(results, method, run, level, [name])
        if intervals is None:
            continue
        lower, upper = intervals[:, 0].T
        part = pd.DataFrame({"true": true, "lower": lower, "upper": upper}).iloc[order]
        part["covered"] = (part["lower"] <= part["true"]) & (part["true"] <= part["upper"])
        key = {
            "model": run.model,
            "preset": run.preset,
            "interval_method": method,
            "title": results.method_titles[method],
        }
        parts.append(part.assign(**key, coordinate=name, confidence_level=level))
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw positions and intervals as the paper does (above), and relative to the true position (below)."""
    groups = list(frame.groupby("interval_method", sort=False))
    figure, axes = panels(2, len(groups), PAGE, 4.8, sharex=True, sharey="row")
    for column, (_, rows) in enumerate(groups):
        first = rows.iloc[0]
        _draw(axes[0][column], rows, np.zeros(len(rows)))
        _draw(axes[1][column], rows, rows["true"].to_numpy())
        width = (rows["upper"] - rows["lower"]).mean()
        axes[0][column].set_title(
            f"{first['title']}\n{first['model']} {first['preset']}\n"
            f"covers {rows['covered'].mean():.1%}\nmean width {width:.3g} {results.unit}",
            fontsize=8,
        )
        axes[1][column].axhline(0.0, color=GREY, linewidth=0.4)
        axes[1][column].set_xlabel("row of test, sorted")
    coordinate, level = frame["coordinate"].iloc[0], frame["confidence_level"].iloc[0]
    axes[0][0].set_ylabel(f"{coordinate} ({results.unit})")
    axes[1][0].set_ylabel(f"distance from the true\nposition ({results.unit})")
    legend_below(figure, axes[0][0].get_legend_handles_labels()[0], 3)
    heading(figure, results, f"{level:.0%} intervals of {coordinate}", rows_of=[TEST])
    return figure


def _draw(axes: Axes, rows: pd.DataFrame, origin: Array) -> None:
    place = drawn_rows(len(rows))
    rows, origin = rows.iloc[place], origin[place]
    lower, upper, true = (rows[name].to_numpy() - origin for name in ("lower", "upper", "true"))
    missed = ~rows["covered"].to_numpy()
    axes.fill_between(place, lower, upper, step="mid", color=SKY, alpha=0.6, linewidth=0, label="interval")
    axes.plot(place, true, color=BLUE, linewidth=1.0, label="true position")
    axes.plot(place[missed], true[missed], ".", color=VERMILION, markersize=4, label="true position, missed")


PAPER_RECIPE = FigureSpec(
    "intervals_paper",
    "Intervals around the paper's model",
    "Intervals of the paper's four methods around gradient boosting with the paper's settings, for the coordinate that "
    "moves furthest on test, rows sorted by true position (the paper's Figure 6); below, the same relative to the true "
    "position. The line of zero should lie in the blue band in as many rows as the level says: red dots are the rows "
    "that are missed. Of two methods that cover as asked, the one with the narrower band is better.",
    partial(frame, is_papers=True),
    plot,
)
DEPLOYED_MODEL = FigureSpec(
    "intervals_deployed",
    "Intervals around the deployed model",
    "The same four methods around the deployed model; QR and CQR have quantile regressors of their own. Compare the "
    "mean widths with those around the paper's model: a better model has a narrower band at the same coverage.",
    partial(frame, is_papers=False),
    plot,
)
