"""Distribution of a marker's positions in each subset (the paper's Figure 3)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from softkin.core.samples import SUBSETS, TRAIN, coordinate_columns, informative_coordinates
from softkin.data.table import read_subset
from softkin.reporting.figures.reading import shown_coordinate
from softkin.reporting.figures.sampling import evenly_spaced
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import PAGE, SUBSET_COLOURS, heading, legend_below, panels, sample

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns subset, coordinate, position_mm, share: sorted positions of the marker that moves furthest on `train`,
    and the share of rows up to each; of very many rows, some evenly spaced ones. Its constant coordinates are left out;
    no run is shown.
    """
    train = read_subset(results.table, TRAIN).positions
    moving, names = informative_coordinates(train), coordinate_columns(train.shape[1] // 3)
    first = shown_coordinate(results)[0] // 3 * 3
    parts = []
    for subset in SUBSETS:
        positions = read_subset(results.table, subset).positions
        places = evenly_spaced(len(positions))
        share = (places + 1) / len(positions)
        for i in (i for i in range(first, first + 3) if moving[i]):
            part = pd.DataFrame({"position_mm": np.sort(positions[:, i])[places], "share": share})
            parts.append(part.assign(subset=subset, coordinate=names[i]))
    return pd.concat(parts, ignore_index=True).assign(model="", preset="", interval_method="")


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw a panel for each axis of space."""
    groups = list(frame.groupby("coordinate", sort=False))
    figure, axes = panels(1, len(groups), PAGE, 3.0, sharey=True)
    for axis, (coordinate, rows) in zip(axes[0], groups, strict=True):
        for subset, part in rows.groupby("subset", sort=False):
            width = 2.5 if subset == TRAIN else 1.2
            colour = SUBSET_COLOURS[str(subset)]
            axis.step(part["position_mm"], part["share"], where="post", color=colour, linewidth=width)
        axis.set_xlabel(f"{coordinate} ({results.unit})")
    axes[0][0].set_ylabel("share of rows")
    samples = [sample(subset, color=colour, linewidth=1.8) for subset, colour in SUBSET_COLOURS.items()]
    legend_below(figure, samples, len(samples))
    heading(figure, results, f"positions of marker {groups[0][0].split('_')[0]} in each subset", SUBSETS)
    return figure


FIGURE = FigureSpec(
    "distribution",
    "Distribution of positions",
    "Cumulative distribution of each coordinate of the marker that moves furthest, by subset. Validation and test "
    "should lie on the curve of train; if they do not, the split is not random. Extrapolation departs from it: where "
    "its curve lies beyond an end of that of train, models predict positions that they were not fitted to.",
    frame,
    plot,
)
