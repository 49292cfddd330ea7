"""Coverage and Winkler score of interval methods on `test` and on `extrapolation`, beside the oracle's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.runs import PAPERS_LEVEL
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import BLACK, GREY, PAGE, SUBSET_COLOURS, heading, legend_below, panels, sample
from softkin.uncertainty.labelled import LABELLED_METHODS
from softkin.uncertainty.labelled.spec import NO_LABELS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SHOWN = ["coverage", "winkler_ratio_to_oracle", "infinite_share", "guarantee", "labels_used", "refused"]
#: Ratios up to here are drawn as they are, larger and infinite ones at the edge.
MOST = 10.0
#: By whether a method sees labels of the rows.
MARKS = {True: "D", False: "o"}
#: Where on the axis of coverage the refusal of a method is written.
REFUSAL_AT = {EXTRAPOLATION: 0.02, TEST: 0.4}


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, title, subset, confidence_level and those in `SHOWN`: a row per run,
    method and subset, at the level nearest to 0.9; runs without intervals in extrapolation are left out.
    """
    scores = read_csv(results.extrapolation, keep_default_na=False, na_values=[""])
    if scores.empty:
        return scores
    levels = scores["confidence_level"].unique()
    scores = scores[scores["confidence_level"] == min(levels, key=lambda level: abs(level - PAPERS_LEVEL))]
    titles = {**results.method_titles, **{name: method.title for name, method in LABELLED_METHODS.items()}}
    scores = scores.assign(title=scores["interval_method"].map(titles), refused=scores["refused"].fillna(""))
    is_labelled = scores["interval_method"].isin(LABELLED_METHODS)
    scores = pd.concat([scores[~is_labelled], scores[is_labelled]])
    return scores[["model", "preset", "interval_method", "title", "subset", "confidence_level", *SHOWN]]


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw a row of panels for each run: coverage, and the Winkler score in units of the oracle's."""
    runs = list(frame.groupby(["model", "preset"], sort=False))
    most = max(rows["interval_method"].nunique() for _, rows in runs)
    figure, axes = panels(len(runs), 2, PAGE, len(runs) * (0.2 * most + 0.7) + 0.6, sharex="col")
    level = float(frame["confidence_level"].iloc[0])
    for (left, right), ((model, preset), rows) in zip(axes, runs, strict=True):
        names = list(rows["title"].unique())[::-1]
        for subset in (TEST, EXTRAPOLATION):
            _draw(left, right, rows[rows["subset"] == subset], names, subset)
        left.axvline(level, color=BLACK, linewidth=0.8, linestyle="--")
        right.axvline(1.0, color=BLACK, linewidth=0.8, linestyle="--")
        left.set_yticks(range(len(names)), names)
        right.set_yticks(range(len(names)), [""] * len(names))
        left.set_title(f"{results.model_titles[str(model)]}, {preset}", loc="left")
    axes[-1][0].set_xlim(-0.02, 1.04)
    axes[-1][0].set_xlabel("share of coordinates covered")
    axes[-1][1].set_xlabel("Winkler score / the oracle's")
    axes[-1][1].set_xscale("log")
    axes[-1][1].set_xlim(0.2, MOST * 1.3)
    ticks = (0.2, 0.5, 1.0, 2.0, 5.0, MOST)
    axes[-1][1].set_xticks(ticks, [*(f"{tick:g}" for tick in ticks[:-1]), f"≥ {MOST:g}"])
    axes[-1][1].minorticks_off()
    samples = [
        sample(subset, color=SUBSET_COLOURS[subset], marker="o", linestyle="") for subset in (TEST, EXTRAPOLATION)
    ]
    samples.append(sample("labelled: sees true positions", color=GREY, marker="D", markersize=4, linestyle=""))
    samples.append(sample("nominal level, oracle", color=BLACK, linewidth=0.8, linestyle="--"))
    legend_below(figure, samples, 4)
    heading(figure, results, f"{level:.0%} intervals in-domain and in extrapolation")
    return figure


def _draw(left: Axes, right: Axes, rows: pd.DataFrame, names: list[str], subset: str) -> None:
    colour = SUBSET_COLOURS[subset]
    for row in rows.itertuples():
        height = names.index(row.title)
        if row.refused:
            left.text(REFUSAL_AT[subset], height, f"{subset}: refuses", color=colour, fontsize=7, va="center")
            continue
        mark = MARKS[row.labels_used != NO_LABELS]
        look: dict[str, Any] = {"color": colour, "marker": mark, "markersize": 4, "alpha": 0.9}
        left.plot(row.coverage, height, **look)
        ratio = row.winkler_ratio_to_oracle
        right.plot(min(ratio, MOST) if np.isfinite(ratio) else MOST, height, **look)


FIGURE = FigureSpec(
    "extrapolation",
    "Intervals in extrapolation",
    "Coverage of each method's intervals (left), and their Winkler score divided by that of an oracle, which is "
    "calibrated on the very rows it is scored on (right), for the paper's gradient boosting, the deployed model and "
    "the robust ones. A good method stands at both dashed lines on test and on extrapolation: left of the first it "
    "misses too often, right of the second its intervals cost more than they need to. On extrapolation nothing is "
    "guaranteed to a method that sees no true position there; labelled methods (diamonds) see some.",
    frame,
    plot,
)
