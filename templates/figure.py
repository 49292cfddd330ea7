"""Bars of the mean error of every run on `test`."""
# To add a figure: copy this file to src/softkin/reporting/figures/<name>.py, fill in what the comments name, and add to
# src/softkin/reporting/figures/__init__.py the import of the module and the line
#     "my_figure": my_figure.FIGURE,
# in FIGURES, or in CAMPAIGN_FIGURES for one across datasets (of `CampaignResults`). Then run:
# pytest tests/contract/test_figures.py -k my_figure

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from softkin.core.samples import TEST
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import BLUE, PAGE, heading, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, euclidean_mean_mm: mean distance between true and predicted marker."""
    # All numbers that the figure shows, a row of them for each mark; they are written beside the picture as CSV. The
    # columns model, preset and interval_method name the run that a row shows, empty where there is none. Without rows
    # the figure is left out.
    point = pd.read_csv(results.point)
    rows = point.loc[point["subset"] == TEST, ["model", "preset", "euclidean_mean_mm"]]
    return rows.assign(interval_method="").reset_index(drop=True)


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw one panel, a bar for each run."""
    # `panels` asks for no window system and sets fonts and colours; import from matplotlib inside functions only.
    figure, [[axes]] = panels(1, 1, PAGE, 3.2)
    names = [f"{results.model_titles[row.model]}, {row.preset}" for row in frame.itertuples()]
    axes.barh(names, frame["euclidean_mean_mm"], color=BLUE)
    axes.set_xlabel(f"mean marker error on test ({results.unit})")
    heading(figure, results, "mean error in-domain", shows=[TEST])
    return figure


FIGURE = FigureSpec(
    # The key in the registry and the name of the file; what the report calls it.
    "my_figure",
    "My figure",
    # What is drawn, where to look, and what good and bad look like.
    "Mean distance between true and predicted marker on test, of every run. Short bars are good.",
    frame,
    plot,
)
