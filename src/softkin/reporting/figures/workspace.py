"""Map of command space: mean marker error of the deployed model at each command."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, command_columns
from softkin.data.table import read_subset
from softkin.reporting.figures.reading import deployed, mean_marker_errors
from softkin.reporting.figures.sampling import drawn_rows
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import BLACK, LEAST_MM, PAGE, heading, legend_below, logarithmic, panels, sample

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import PathCollection
    from matplotlib.figure import Figure

#: Of robots with more commands, those are drawn whose rank correlation with the error is strongest.
MOST_COMMANDS = 4
ERROR = "error_mm"


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, subset, u1 .., error_mm: a row per drawn row of `train` (without
    error), `test` and `extrapolation`; the error of the deployed model is averaged over the moving markers.
    """
    best = deployed(results)
    if best is None:
        return pd.DataFrame()
    parts = []
    for subset in (TRAIN, TEST, EXTRAPOLATION):
        commands = read_subset(results.table, subset).commands
        ends = [commands.argmin(axis=0), commands.argmax(axis=0)]  # the range of train, which is drawn
        rows = drawn_rows(len(commands), kept=np.ravel(ends))
        part = pd.DataFrame(commands[rows], columns=command_columns(commands.shape[1]))
        errors = np.nan if subset == TRAIN else mean_marker_errors(results, best.run, subset)[rows]
        parts.append(part.assign(subset=subset, **{ERROR: errors}))
    names = {"model": best.model, "preset": best.preset, "interval_method": ""}
    return pd.concat(parts, ignore_index=True).assign(**names)


def shown_commands(frame: pd.DataFrame) -> list[str]:
    """Columns of the commands that are drawn, in their order."""
    commands = [name for name in frame if name.startswith("u")]
    correlation = frame[[*commands, ERROR]].corr("spearman")[ERROR].abs()[commands]
    kept = set(correlation.sort_values(ascending=False, kind="stable").index[:MOST_COMMANDS])
    return [name for name in commands if name in kept]


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw a panel for each pair of commands; for a single command, the error is the other axis."""
    commands = shown_commands(frame)
    pairs = list(combinations(commands, 2)) or [(commands[0], ERROR)]
    n_columns = min(3, len(pairs))
    n_rows = -(-len(pairs) // n_columns)
    height = 4.6 if len(pairs) == 1 else 0.9 + 2.5 * n_rows
    figure, axes = panels(n_rows, n_columns, PAGE, height)
    places = [axis for row in axes for axis in row]
    for axis in places[len(pairs) :]:
        axis.set_axis_off()
    drawn = [_draw(axis, frame, *pair, results.unit) for axis, pair in zip(places, pairs, strict=False)]
    first = frame.iloc[0]
    label = f"mean marker error of\n{results.model_titles[first['model']]}, {first['preset']} ({results.unit})"
    bar = figure.colorbar(drawn[0], ax=places, label=label, shrink=0.9, extend="both")
    logarithmic(bar.ax.yaxis)
    dark = {"linestyle": "", "color": "#444444", "markersize": 4}
    samples = [
        sample("range of train", color=BLACK, linewidth=0.8, linestyle="--"),
        sample("test", marker="o", **dark),
        sample("extrapolation", marker="^", **dark),
    ]
    legend_below(figure, samples, 3)
    heading(figure, results, "mean marker error at each command", rows_of=(TEST, EXTRAPOLATION))
    return figure


def _draw(axes: Axes, frame: pd.DataFrame, across: str, up: str, unit: str) -> PathCollection:
    from matplotlib.colors import LogNorm

    train = frame[frame["subset"] == TRAIN]
    for name, line in ((across, axes.axvline), (up, axes.axhline)):
        for end in [train[name].min(), train[name].max()] if name != ERROR else []:
            line(end, color=BLACK, linewidth=0.8, linestyle="--")
    errors = frame[ERROR].dropna().clip(lower=LEAST_MM)
    norm = LogNorm(*errors.quantile([0.02, 0.98]))
    for subset, mark in ((EXTRAPOLATION, "^"), (TEST, "o")):
        # The worst rows come last, on top.
        rows = frame[frame["subset"] == subset].sort_values(ERROR, kind="stable")
        look: dict[str, Any] = {"marker": mark, "s": 9, "cmap": "viridis_r", "linewidths": 0, "rasterized": True}
        drawn = axes.scatter(rows[across], rows[up], c=rows[ERROR].clip(lower=LEAST_MM), norm=norm, **look)
    axes.locator_params(nbins=4)
    axes.set_xlabel(f"{across} (the data's unit)")
    axes.set_ylabel(f"mean marker error ({unit})" if up == ERROR else f"{up} (the data's unit)")
    if up == ERROR:
        axes.set_yscale("log")
        logarithmic(axes.yaxis)
    return drawn


FIGURE = FigureSpec(
    "workspace",
    "Workspace map",
    "Mean marker error of the deployed model at each command of test (circles) and extrapolation (triangles); dark is "
    "a large error, drawn on top. A good model is light within the dashed lines, the range of train, and darkens "
    "slowly beyond them. A dark spot among light ones is a region that needs more data, a single dark mark a gross "
    "error.",
    frame,
    plot,
)
