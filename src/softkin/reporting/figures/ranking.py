"""Ranking of all models of a dataset: mean error on `test` against mean error on `extrapolation`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.runs import OUTER, PAPER
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.reporting.figures.reading import deployed
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import (
    BLACK,
    GREY,
    LEAST_MM,
    LOOKS,
    PAGE,
    heading,
    logarithmic,
    model_samples,
    panels,
    sample,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ERROR = "euclidean_mean_mm"


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, test, extrapolation (mean error of a marker, mm), chosen: whether
    it is deployed.
    """
    point = read_csv(results.point)
    key = ["model", "preset"]
    table = point.pivot_table(index=key, columns="subset", values=ERROR, sort=False)[[TEST, EXTRAPOLATION]]
    best = deployed(results)
    rows = table.reset_index().rename_axis(columns=None)
    is_deployed = [best is not None and run == best.run for run in zip(rows["model"], rows["preset"], strict=True)]
    return rows.assign(interval_method="", chosen=is_deployed)


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw one log-log panel; a line joins the presets of a model."""
    figure, [[axes]] = panels(1, 1, PAGE, 4.6)
    models = list(frame["model"].unique())
    for model in models:
        colour, mark = LOOKS[model]
        rows = frame[frame["model"] == model]
        rows = rows.assign(**rows[[TEST, EXTRAPOLATION]].clip(lower=LEAST_MM))
        axes.loglog(rows[TEST], rows[EXTRAPOLATION], color=colour, linewidth=0.8, alpha=0.6)
        for row in rows.itertuples():
            axes.plot(row.test, row.extrapolation, mark, markersize=7, **_look(row.preset, colour))
            if row.chosen:
                axes.plot(row.test, row.extrapolation, "o", color=BLACK, markerfacecolor="none", markersize=14)
    logarithmic(axes.xaxis)
    logarithmic(axes.yaxis)
    axes.set(xlim=axes.get_xlim(), ylim=axes.get_ylim())
    axes.axline((1.0, 1.0), (10.0, 10.0), color=GREY, linewidth=0.8, linestyle="--")
    axes.set_xlabel(f"mean marker error on test ({results.unit})")
    axes.set_ylabel(f"mean marker error on extrapolation ({results.unit})")
    samples = model_samples(models, results)
    for preset in frame["preset"].unique():
        samples.append(sample(f"{preset} preset", marker="o", linestyle="", **_look(preset, GREY)))
    if frame["chosen"].any():
        look = {"color": BLACK, "marker": "o", "markerfacecolor": "none", "markersize": 11, "linestyle": ""}
        samples.append(sample("deployed", **look))
    samples.append(sample("equal errors", color=GREY, linewidth=0.8, linestyle="--"))
    figure.legend(handles=samples, loc="outside right center", frameon=False)
    heading(figure, results, "mean error in-domain and in extrapolation")
    return figure


def _look(preset: str, colour: str) -> dict[str, Any]:
    """Look of a preset: an open mark for the paper's, a full one for searched ones, with a black edge for `outer`."""
    edge = BLACK if preset == OUTER else colour
    return {"color": colour, "markerfacecolor": "white" if preset == PAPER else colour, "markeredgecolor": edge}


FIGURE = FigureSpec(
    "ranking",
    "Ranking of models",
    "Mean distance between true and predicted marker on test and on extrapolation, of every model with the paper's "
    "settings and with searched ones. The best run is the one nearest to the lower left corner. The height above the "
    "dashed line is the price of extrapolation: a run on it is as good there as in-domain. The ring marks the deployed "
    "run, which was chosen on train alone. Errors below 1e-9 of the axis' unit are drawn there.",
    frame,
    plot,
)
