"""All models of a dataset at one glance: error inside the training range against error outside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

from softkin.core.runs import OUTER, PAPER
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.reporting.figures.reading import chosen
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
    """Columns model, preset, interval_method, test, extrapolation (mean error of a marker, mm), chosen."""
    point = pd.read_csv(results.point)
    key = ["model", "preset"]
    table = point.pivot_table(index=key, columns="subset", values=ERROR, sort=False)[[TEST, EXTRAPOLATION]]
    best = chosen(results)
    rows = table.reset_index().rename_axis(columns=None)
    is_chosen = [best is not None and run == best.run for run in zip(rows["model"], rows["preset"], strict=True)]
    return rows.assign(interval_method="", chosen=is_chosen)


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Log-log; a line joins the presets of a model."""
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
    axes.set_xlabel("mean marker error on test (mm)")
    axes.set_ylabel("mean marker error on extrapolation (mm)")
    samples = model_samples(models, results)
    for preset in frame["preset"].unique():
        samples.append(sample(f"{preset} preset", marker="o", linestyle="", **_look(preset, GREY)))
    if frame["chosen"].any():
        look = {"color": BLACK, "marker": "o", "markerfacecolor": "none", "markersize": 11, "linestyle": ""}
        samples.append(sample("chosen on train", **look))
    samples.append(sample("as good outside as inside", color=GREY, linewidth=0.8, linestyle="--"))
    figure.legend(handles=samples, loc="outside right center", frameon=False)
    heading(figure, results, "inside and outside the training range")
    return figure


def _look(preset: str, colour: str) -> dict[str, Any]:
    """Open with the paper's settings, full when searched; searched by outer shells with a black edge."""
    edge = BLACK if preset == OUTER else colour
    return {"color": colour, "markerfacecolor": "white" if preset == PAPER else colour, "markeredgecolor": edge}


FIGURE = FigureSpec(
    "ranking",
    "Ranking of models",
    "Mean distance between true and predicted marker, on test and on extrapolation, of every model with the paper's "
    "settings and tuned. Lower left is better; above the dashed line a model is worse outside its training range. "
    "Errors below 1e-9 mm are drawn there.",
    frame,
    plot,
)
