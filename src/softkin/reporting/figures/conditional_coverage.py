"""Conditional coverage on `test`: by command, position, interval width, marker, and in the worst slab of commands."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.reporting.figures.reading import candidates, deployed
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import BLACK, PAGE, PALETTE, heading, legend_below, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PANELS = {
    "command_norm": "command norm, fifths",
    "predicted_position": "distance of the predicted pose\nfrom the mean pose, fifths",
    "width": "interval width, fifths",
    "marker": "marker",
    "slab": "worst slab of\ncommand space",
}
#: Panels in a row; with more, labels overlap.
N_COLUMNS = 3
#: Both libraries of split conformal prediction give the same intervals, so one of them is drawn.
LEFT_OUT = ("scp_crepes",)
MARKS = "osD^vP*X"


def frame(results: DatasetResults) -> pd.DataFrame:
    """Rows of conditional_coverage.csv of the deployed model and of the best CQR, with the `title` of the method."""
    table = read_csv(results.conditional, dtype={"group": str})
    choice = candidates(results)
    best = deployed(results)
    cqr = choice[choice["has_own_regressors"]].head(1)
    kept = {(*best.run, method) for method in table["interval_method"]} if best else set()
    kept |= set(zip(cqr["model"], cqr["preset"], cqr["interval_method"], strict=True))
    kept = {intervals for intervals in kept if intervals[2] not in LEFT_OUT}
    rows = zip(table["model"], table["preset"], table["interval_method"], strict=True)
    shown = table[np.array([row in kept for row in rows]) & table["by"].isin(PANELS)]
    titles = shown["interval_method"].map(dict(results.method_titles))
    return shown.assign(title=titles + ", " + shown["model"] + " " + shown["preset"])


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw a panel for each way to group the rows; bars are two standard errors, the line is the nominal level."""
    shown = [by for by in PANELS if by in set(frame["by"])]
    n_columns = min(N_COLUMNS, len(shown))
    n_rows = -(-len(shown) // n_columns)
    figure, axes = panels(n_rows, n_columns, PAGE, 0.6 + 2.6 * n_rows, sharey=True)
    places = [axis for row in axes for axis in row]
    for axis in places[len(shown) :]:
        axis.set_axis_off()
    titles = list(frame["title"].unique())
    for axis, by in zip(places, shown, strict=False):
        panel = frame[frame["by"] == by]
        groups = list(dict.fromkeys(panel["group"]))
        for place, title in enumerate(titles):
            rows = panel[panel["title"] == title].set_index("group")
            if rows.empty:
                continue
            shift = (place - (len(titles) - 1) / 2) * 0.7 / len(titles)
            axis.errorbar(
                np.array([groups.index(group) for group in rows.index]) + shift,
                rows["coverage"],
                yerr=2 * rows["standard_error"],
                fmt=MARKS[place % len(MARKS)],
                color=PALETTE[place % len(PALETTE)],
                markersize=4,
                linewidth=1,
                label=title,
            )
        axis.axhline(panel["confidence_level"].iloc[0], color=BLACK, linewidth=0.8, linestyle="--")
        axis.set_xticks(range(len(groups)), groups)
        axis.set_xlabel(PANELS[by])
    for row in axes:
        row[0].set_ylabel("coverage on test")
    axes[0][0].set_ylim(top=1.02)
    legend_below(figure, axes[0][0].get_legend_handles_labels()[0], 3)
    heading(figure, results, "coverage of groups of rows")
    return figure


FIGURE = FigureSpec(
    "conditional_coverage",
    "Conditional coverage",
    "Coverage on test of groups of rows: by command norm, position, interval width and marker, and of the worst slab "
    "of command space. Bars are two standard errors, the dashed line is the nominal level. A good method stays at the "
    "line in every group. A group whose bar ends below the line is one where intervals are too narrow, although the "
    "coverage over all rows may be as asked.",
    frame,
    plot,
)
