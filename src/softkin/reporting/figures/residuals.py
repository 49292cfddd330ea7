"""Residuals of the deployed model by marker and coordinate."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, coordinate_columns, informative_coordinates
from softkin.data.table import read_subset
from softkin.reporting.figures.reading import deployed, predicted
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PAGE,
    heading,
    legend_below,
    panels,
    sample,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

AXIS_COLOURS = {"x": BLUE, "y": ORANGE, "z": GREEN}
QUANTILES = {"whislo": 0.05, "q1": 0.25, "med": 0.5, "q3": 0.75, "whishi": 0.95}


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, subset, marker, axis, whislo .. whishi, mean (mm): quantiles of predicted
    minus true, a row per moving coordinate of `test` and `extrapolation`.
    """
    best = deployed(results)
    if best is None:
        return pd.DataFrame()
    moving = informative_coordinates(read_subset(results.table, TRAIN).positions)
    columns = coordinate_columns(len(moving) // 3)
    rows = []
    for subset in (TEST, EXTRAPOLATION):
        residuals = predicted(results, best.run, subset, columns) - read_subset(results.table, subset).positions
        for i in np.flatnonzero(moving):
            marker, axis = columns[i].split("_")
            numbers = {name: np.quantile(residuals[:, i], level) for name, level in QUANTILES.items()}
            key = {"model": best.model, "preset": best.preset, "interval_method": "", "subset": subset}
            rows.append(key | {"marker": marker, "axis": axis} | numbers | {"mean": residuals[:, i].mean()})
    return pd.DataFrame(rows)


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw test above extrapolation, each at its own scale; a group of boxes for each marker."""
    figure, axes = panels(2, 1, PAGE, 4.6, sharex=True)
    for [axis], (subset, rows) in zip(axes, frame.groupby("subset", sort=False), strict=True):
        _draw(axis, rows)
        axis.set_ylabel(f"{subset}\npredicted - true ({results.unit})")
    axes[1][0].set_xlabel("marker, counted from the base")
    samples = [sample(f"{axis} axis", color=colour, linewidth=6, alpha=0.7) for axis, colour in AXIS_COLOURS.items()]
    legend_below(figure, samples, 3)
    first = frame.iloc[0]
    heading(figure, results, f"residuals of {results.model_titles[first['model']]}, {first['preset']}")
    return figure


def _draw(axes: Axes, rows: pd.DataFrame) -> None:
    markers = list(rows["marker"].unique())
    for place, (name, colour) in enumerate(AXIS_COLOURS.items()):
        of_axis = rows[rows["axis"] == name]
        statistics = [{**dict(row), "fliers": []} for row in of_axis[list(QUANTILES)].to_dict("records")]
        axes.bxp(
            statistics,
            positions=[markers.index(marker) + 0.26 * (place - 1) for marker in of_axis["marker"]],
            widths=0.2,
            patch_artist=True,
            showfliers=False,
            boxprops={"facecolor": colour, "alpha": 0.7, "linewidth": 0.5},
            medianprops={"color": BLACK},
            whiskerprops={"color": GREY},
            capprops={"color": GREY},
        )
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    axes.set_xticks(range(len(markers)), markers)
    axes.grid(visible=False, axis="x")


FIGURE = FigureSpec(
    "residuals",
    "Residuals by marker",
    "Predicted minus true position of the deployed model by coordinate: median, middle half of the rows (box), and 5 % "
    "to 95 % quantile (whiskers). The boxes of a good model are short and centred on zero. A box off zero is a bias, "
    "which on extrapolation is to be expected; boxes that grow towards the tip are errors that add up along the robot. "
    "Constant coordinates are left out.",
    frame,
    plot,
)
