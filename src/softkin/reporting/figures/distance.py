"""Error of a model against the distance of a command from the nearest one of `train`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, Array
from softkin.data.table import read_subset
from softkin.models.spec import PAPERS_RUN
from softkin.reporting.figures.reading import deployed, mean_marker_errors
from softkin.reporting.figures.sampling import drawn_rows
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import (
    BLACK,
    LEAST_MM,
    PAGE,
    SUBSET_COLOURS,
    heading,
    legend_below,
    logarithmic,
    panels,
    sample,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Rows in equal parts, by distance, of which the median error is drawn.
N_PARTS = 12


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, subset, distance, error_mm: a row per drawn row of `test` and
    `extrapolation`, of the deployed model and of the paper's.

    `distance` is that of the nearest command of `train`, each command in units of its standard deviation on `train`;
    `error_mm` the distance between true and predicted marker, averaged over the moving markers.
    """
    best = deployed(results)
    runs = [*([best.run] if best else []), PAPERS_RUN]
    commands = {subset: read_subset(results.table, subset).commands for subset in (TEST, EXTRAPOLATION)}
    rows = {subset: drawn_rows(len(of_subset)) for subset, of_subset in commands.items()}
    distance = distances(results, [of_subset[rows[subset]] for subset, of_subset in commands.items()])
    parts = [
        pd.DataFrame(
            {"distance": of_subset, "error_mm": mean_marker_errors(results, run, subset)[rows[subset]]}
        ).assign(model=run[0], preset=run[1], interval_method="", subset=subset)
        for run in dict.fromkeys(runs)
        if run in results.predictions
        for subset, of_subset in zip(commands, distance, strict=True)
    ]
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def distances(results: DatasetResults, commands: Sequence[Array]) -> list[Array]:
    """Distances (n_rows,) of several sets of commands to the nearest of `train`, in standardised command space."""
    from sklearn.neighbors import NearestNeighbors
    from sklearn.preprocessing import StandardScaler

    train = read_subset(results.table, TRAIN).commands
    scaler = StandardScaler().fit(train)
    finder = NearestNeighbors(n_neighbors=1).fit(scaler.transform(train))
    return [np.asarray(finder.kneighbors(scaler.transform(rows))[0][:, 0]) for rows in commands]


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw a panel for each model; the line is the median error of rows of like distance."""
    runs = list(frame.groupby(["model", "preset"], sort=False))
    figure, axes = panels(1, len(runs), PAGE, 3.4, sharex=True, sharey=True)
    for axis, ((model, preset), rows) in zip(axes[0], runs, strict=True):
        for subset, part in rows.groupby("subset", sort=False):
            colour = SUBSET_COLOURS[str(subset)]
            errors = part["error_mm"].clip(lower=LEAST_MM)
            axis.plot(part["distance"], errors, ".", color=colour, markersize=2, alpha=0.6, rasterized=True)
        ordered = rows.sort_values("distance", kind="stable")
        groups = np.array_split(np.arange(len(ordered)), N_PARTS)
        medians = [ordered.iloc[group][["distance", "error_mm"]].median() for group in groups if len(group)]
        line = pd.DataFrame(medians).groupby("distance")["error_mm"].median()
        axis.semilogy(line.index, line.clip(lower=LEAST_MM), color=BLACK, linewidth=1.4)
        axis.set_title(f"{results.model_titles[str(model)]}, {preset}")
        axis.set_xlabel("distance to the nearest train command\n(standard deviations of a command)")
    logarithmic(axes[0][0].yaxis)
    axes[0][0].set_ylabel(f"mean marker error ({results.unit})")
    samples = [
        sample(subset, color=SUBSET_COLOURS[subset], marker=".", linestyle="") for subset in (TEST, EXTRAPOLATION)
    ]
    legend_below(figure, [*samples, sample("median of rows of like distance", color=BLACK, linewidth=1.4)], 3)
    heading(figure, results, "error against distance from train", rows_of=(TEST, EXTRAPOLATION))
    return figure


FIGURE = FigureSpec(
    "distance",
    "Error against distance",
    "Mean marker error of each row against the distance of its command from the nearest one of train, for the deployed "
    "model and for the paper's gradient boosting. Follow the black line, the median: a model that extrapolates well "
    "keeps it flat, one that does not lets it climb as soon as commands leave those of train.",
    frame,
    plot,
)
