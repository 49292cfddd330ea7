"""The paper's Figures 4 and 5: the true position against what every model predicts, rows sorted."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from softkin.core.runs import OUTER, PAPER, TUNED
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.data.table import read_subset
from softkin.reporting.figures.reading import predicted, shown_coordinate
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import BLACK, LIGHT, LOOKS, PAGE, heading, legend_below, panels, sample

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

N_COLUMNS = 4
#: Of the searched presets, which to show where: the first that was run.
MEANT_FOR = {TEST: (TUNED, OUTER), EXTRAPOLATION: (OUTER, TUNED)}
#: A panel shows this share of the true range beyond it, at either end.
MARGIN = 0.3
OFF_SCALE: dict[str, Any] = {"fontsize": 6.5, "bbox": {"color": "white", "alpha": 0.8, "pad": 1.0}}


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, subset, coordinate, place, true_mm, predicted_mm: a row per run and row
    of `test` and `extrapolation`, sorted by true position, of the coordinate that moves furthest on `train`.
    """
    coordinate, name = shown_coordinate(results)
    parts = []
    for subset in (TEST, EXTRAPOLATION):
        true = read_subset(results.table, subset).positions[:, coordinate]
        order = np.argsort(true, kind="stable")
        for run in results.predictions:
            mine = predicted(results, run, subset, [name])[:, 0]
            part = pd.DataFrame({"place": range(len(true)), "true_mm": true[order], "predicted_mm": mine[order]})
            key = {
                "model": run.model,
                "preset": run.preset,
                "interval_method": "",
                "subset": subset,
                "coordinate": name,
            }
            parts.append(part.assign(**key))
    return pd.concat(parts, ignore_index=True)


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """A column for each model: test above, extrapolation below; four models side by side."""
    models = list(frame["model"].unique())
    n_blocks = -(-len(models) // N_COLUMNS)
    n_columns = min(len(models), N_COLUMNS)
    figure, axes = panels(2 * n_blocks, n_columns, PAGE, 0.8 + 3.0 * n_blocks)
    for place in range(n_blocks * n_columns):
        block, column = divmod(place, n_columns)
        for row, subset in enumerate((TEST, EXTRAPOLATION)):
            axis = axes[2 * block + row][column]
            if place >= len(models):
                axis.set_axis_off()
                continue
            mine = frame[(frame["model"] == models[place]) & (frame["subset"] == subset)]
            _draw(axis, mine[mine["preset"].isin(_shown_presets(frame, subset))])
            axis.tick_params(labelleft=column == 0)
            axis.locator_params(nbins=4)
            if row == 0:
                axis.set_title(results.model_titles[models[place]])
            if row == 1:
                axis.set_xlabel("row, sorted by position")
            if column == 0:
                axis.set_ylabel(f"{subset}\n{frame['coordinate'].iloc[0]} (mm)")
    samples = [sample("true position", color=BLACK, linewidth=1.2)]
    for is_paper in dict.fromkeys(preset == PAPER for preset in frame["preset"]):
        colour = LIGHT if is_paper else LOOKS[models[0]][0]
        meaning = "predicted, paper preset" if is_paper else "predicted, searched (in the model's colour)"
        samples.append(sample(meaning, color=colour, linestyle="", marker="."))
    legend_below(figure, samples, len(samples))
    heading(figure, results, f"true and predicted {frame['coordinate'].iloc[0]}")
    return figure


def _shown_presets(frame: pd.DataFrame, subset: str) -> set[str]:
    """The paper's, and of those searched the one meant for such commands, where it was run."""
    run = set(frame["preset"])
    return (run & {PAPER}) | {next((preset for preset in MEANT_FOR[subset] if preset in run), PAPER)}


def _draw(axes: Axes, rows: pd.DataFrame) -> None:
    """Predictions far outside the true range are counted, not drawn."""
    true = rows.drop_duplicates("place")
    low, high = true["true_mm"].min(), true["true_mm"].max()
    low, high = low - MARGIN * (high - low), high + MARGIN * (high - low)
    outside = []
    for (model, preset), part in rows.groupby(["model", "preset"], sort=False):
        colour = LIGHT if preset == PAPER else LOOKS[str(model)][0]
        axes.plot(part["place"], part["predicted_mm"], ".", color=colour, markersize=1.8, rasterized=True)
        n_outside = int((~part["predicted_mm"].between(low, high)).sum())
        outside += [f"{preset}: {n_outside} off the scale"] if n_outside else []
    axes.plot(true["place"], true["true_mm"], color=BLACK, linewidth=1.0)
    axes.set_ylim(low, high)
    if outside:
        axes.text(0.97, 0.03, "\n".join(outside), transform=axes.transAxes, ha="right", va="bottom", **OFF_SCALE)


FIGURE = FigureSpec(
    "position_curves",
    "Position curves",
    "True position (line) of the coordinate that moves furthest, rows sorted by it, and what each model predicts "
    "(dots) on test and on extrapolation: with the paper's settings, and with those searched for such commands, of the "
    "preset tuned on test and outer on extrapolation.",
    frame,
    plot,
)
