"""Error on `extrapolation` of every model fitted to positions and to curvature coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.runs import OUTER
from softkin.core.samples import EXTRAPOLATION
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import (
    BLACK,
    GREY,
    LEAST_MM,
    LOOKS,
    PAGE,
    heading,
    legend_below,
    logarithmic,
    panels,
    sample,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ERRORS = {"rmse_mm": "RMSE on extrapolation", "mae_mm": "MAE on extrapolation"}
#: An open mark is a model of positions, a full one a model of anything else.
POSITIONS = "cartesian"


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, target_space, is_chosen, rmse_mm, mae_mm: a row per model and space."""
    scores = read_csv(results.target_spaces)
    scores = scores[scores["subset"] == EXTRAPOLATION].reset_index(drop=True)
    return scores[["model", "target_space", "is_chosen", *ERRORS]].assign(preset=OUTER, interval_method="")


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw a line per model from one target space to the other; RMSE left, MAE right."""
    models = list(frame["model"].unique())[::-1]
    figure, [axes] = panels(1, len(ERRORS), PAGE, 0.26 * len(models) + 1.5, sharey=True)
    for panel, (error, label) in zip(axes, ERRORS.items(), strict=True):
        for height, model in enumerate(models):
            _draw(panel, frame[frame["model"] == model], error, height)
        panel.set_xscale("log")
        logarithmic(panel.xaxis, most_numbers=6)
        panel.set_xlabel(f"{label} ({results.unit})")
    axes[0].set_yticks(range(len(models)), [results.model_titles[model] for model in models])
    samples = [
        sample("fitted to positions", color=GREY, marker="o", markerfacecolor="white", linestyle=""),
        sample("fitted to curvature coordinates", color=GREY, marker="o", linestyle=""),
        sample("chosen in the study", color=BLACK, marker="o", markerfacecolor="none", markersize=10, linestyle=""),
    ]
    legend_below(figure, samples, 3)
    heading(figure, results, "error in extrapolation by target space", [EXTRAPOLATION])
    return figure


def _draw(panel: Axes, rows: pd.DataFrame, error: str, height: int) -> None:
    colour, mark = LOOKS[rows["model"].iloc[0]]
    values = rows[error].clip(lower=LEAST_MM)
    panel.plot(values, [height] * len(values), color=colour, linewidth=1.5, alpha=0.6)
    for value, row in zip(values, rows.itertuples(), strict=True):
        filling = "white" if row.target_space == POSITIONS else colour
        panel.plot(value, height, mark, color=colour, markerfacecolor=filling, markersize=6)
        if row.is_chosen:
            panel.plot(value, height, "o", color=BLACK, markerfacecolor="none", markersize=11, markeredgewidth=0.7)


FIGURE = FigureSpec(
    "target_spaces",
    "Target spaces",
    "Errors on extrapolation of every model fitted to positions (open marks) and to curvature coordinates (full "
    "marks), each with the best parameters of its study of preset outer. Where the full mark is left of the open one, "
    "curvature coordinates help this model to extrapolate. A ring marks the space that the study chose, on train "
    "alone: a good choice is the left one of the two. Errors below 1e-9 of the axis' unit are drawn there.",
    frame,
    plot,
)
