"""Error on `test` by the share of `train` that a model is fitted to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.escaping import figure_text
from softkin.reporting.figures.spec import CampaignResults, FigureSpec
from softkin.reporting.figures.style import LEAST_MM, LOOKS, PAGE, legend_below, logarithmic, panels, sample
from softkin.reporting.units import UNIT, heading_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def frame(results: CampaignResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, dataset, share, n_rows, rmse_mm, leak: a row per run and share; `unit` of
    its errors where a dataset is not in mm.
    """
    if results.learning_curve is None:
        return pd.DataFrame()
    curves = read_csv(results.learning_curve)
    columns = ["dataset", "model", "preset", "share", "n_rows", "rmse_mm", "leak", *([UNIT] if UNIT in curves else [])]
    return curves[columns].assign(interval_method="")


def plot(frame: pd.DataFrame, results: CampaignResults) -> Figure:
    """Draw a row of panels for each preset, a column for each dataset, a line for each model."""
    datasets, presets = list(frame["dataset"].unique()), list(frame["preset"].unique())
    figure, axes = panels(len(presets), len(datasets), PAGE, 0.9 + 2.1 * len(presets), sharex=True)
    for line, preset in zip(axes, presets, strict=True):
        for panel, dataset in zip(line, datasets, strict=True):
            rows = frame[(frame["preset"] == preset) & (frame["dataset"] == dataset)]
            _draw(panel, rows)
            name = figure_text(results.dataset_titles[dataset].split(" (")[0])
            panel.set_title(f"{name}{' (leak)' if rows['leak'].any() else ''}\n{preset}", fontsize=8)
        line[0].set_ylabel(f"RMSE on test ({heading_of(frame)})")
    for panel in axes[-1]:
        panel.set_xlabel("share of train")
    models = list(frame["model"].unique())
    samples = [
        sample(results.model_titles[name], color=LOOKS[name][0], marker=LOOKS[name][1], markersize=4) for name in models
    ]
    legend_below(figure, samples, min(3, len(samples)))
    figure.suptitle("error by the share of train that models are fitted to", fontsize=10)
    return figure


def _draw(panel: Axes, rows: pd.DataFrame) -> None:
    for model, of_model in rows.groupby("model", sort=False):
        colour, mark = LOOKS[str(model)]
        panel.plot(of_model["share"], of_model["rmse_mm"].clip(lower=LEAST_MM), color=colour, marker=mark, markersize=4)
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.set_xticks(shares := sorted(rows["share"].unique()), [f"{share:.0%}" for share in shares])
    panel.minorticks_off()
    logarithmic(panel.yaxis, most_numbers=6)


FIGURE = FigureSpec(
    "learning_curve",
    "Learning curves",
    "RMSE on test of nonlinear models that are fitted to a part of train, drawn at random, with the settings of the "
    "paper and with searched ones. A line that still falls at the right end needs more data; one that is flat has had "
    "enough. A model that needs more data than others falls more steeply. Where test leaks, it is training error.",
    frame,
    plot,
)
