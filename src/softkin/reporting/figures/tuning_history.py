"""History of the studies: each trial's score, and the best score so far of each model."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.runs import TUNED
from softkin.core.samples import TRAIN
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import LOOKS, PAGE, heading, logarithmic, model_samples, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, trial, score_mm, best_mm: a row per complete trial, and the best score
    up to it.
    """
    parts = []
    for model, path in results.trials.items():
        trials = read_csv(path)[["trial", "score_mm"]].dropna().sort_values("trial")
        parts.append(trials.assign(model=model, preset=TUNED, interval_method="", best_mm=trials["score_mm"].cummin()))
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw all models in one panel, with a mark for each complete trial."""
    figure, [[axes]] = panels(1, 1, PAGE, 3.8)
    last = frame["trial"].max()
    for model, trials in frame.groupby("model", sort=False):
        colour, mark = LOOKS[str(model)]
        axes.semilogy(trials["trial"], trials["score_mm"], mark, color=colour, markersize=3, alpha=0.45)
        steps = [*trials["trial"], last], [*trials["best_mm"], trials["best_mm"].iloc[-1]]
        axes.step(*steps, where="post", color=colour, linewidth=1.5)
    logarithmic(axes.yaxis)
    axes.set_xlabel("trial")
    axes.set_ylabel(f"cross-validated mean absolute error\non train ({results.unit})")
    samples = model_samples(frame["model"].unique(), results)
    figure.legend(handles=samples, loc="outside right center", frameon=False)
    heading(figure, results, "trials of the studies, and the best so far", [TRAIN])
    return figure


FIGURE = FigureSpec(
    "tuning_history",
    "Tuning history",
    "Cross-validated error within train of each complete trial (marks), and the best so far (lines). A line that is "
    "flat over its last third has had enough trials; one that still falls at the end would gain from more. Marks far "
    "above their line are parameters to avoid. Pruned trials have no mark.",
    frame,
    plot,
)
