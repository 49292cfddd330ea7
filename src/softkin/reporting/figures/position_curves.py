"""True and predicted position of every model, rows sorted by true position (the paper's Figures 4 and 5)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from softkin.core.runs import OUTER, PAPER, TUNED
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.data.table import read_subset
from softkin.reporting.figures.reading import predicted, shown_coordinate
from softkin.reporting.figures.sampling import drawn_rows
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import BLACK, LIGHT, LOOKS, PAGE, heading, legend_below, panels, sample

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

N_COLUMNS = 4
#: The searched presets by subset: the first one that was run is shown.
SEARCHED_FOR = {TEST: (TUNED, OUTER), EXTRAPOLATION: (OUTER, TUNED)}
#: A panel extends beyond the true range by this share of it, at either end.
MARGIN = 0.3
OFF_SCALE: dict[str, Any] = {"fontsize": 6.5, "bbox": {"color": "white", "alpha": 0.8, "pad": 1.0}}


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, subset, coordinate, place, true_mm, predicted_mm: a row per run and drawn
    row of `test` and `extrapolation`, sorted by true position, of the coordinate that moves furthest on `train`.
    """
    coordinate, name = shown_coordinate(results)
    parts = []
    for subset in (TEST, EXTRAPOLATION):
        true = read_subset(results.table, subset).positions[:, coordinate]
        rows = drawn_rows(len(true))
        true = true[rows]
        order = np.argsort(true, kind="stable")
        for run in results.predictions:
            guess = predicted(results, run, subset, [name])[rows, 0]
            part = pd.DataFrame({"place": range(len(true)), "true_mm": true[order], "predicted_mm": guess[order]})
            key = {"model": run.model, "preset": run.preset, "interval_method": "", "subset": subset}
            parts.append(part.assign(**key, coordinate=name))
    return pd.concat(parts, ignore_index=True)


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw a column for each model, test above extrapolation; four models side by side."""
    models = list(frame["model"].unique())
    n_blocks = -(-len(models) // N_COLUMNS)
    n_columns = min(len(models), N_COLUMNS)
    figure, axes = panels(2 * n_blocks, n_columns, PAGE, 0.8 + 3.0 * n_blocks)
    for place in range(n_blocks * n_columns):
        block, column = divmod(place, n_columns)
        for line, subset in enumerate((TEST, EXTRAPOLATION)):
            axis = axes[2 * block + line][column]
            if place >= len(models):
                axis.set_axis_off()
                continue
            rows = frame[(frame["model"] == models[place]) & (frame["subset"] == subset)]
            _draw(axis, rows[rows["preset"].isin(_shown_presets(frame, subset))])
            axis.tick_params(labelleft=column == 0)
            axis.locator_params(nbins=4)
            if line == 0:
                axis.set_title(results.model_titles[models[place]])
            if line == 1:
                axis.set_xlabel("row, sorted by position")
            if column == 0:
                axis.set_ylabel(f"{subset}\n{frame['coordinate'].iloc[0]} ({results.unit})")
    samples = [sample("true position", color=BLACK, linewidth=1.2)]
    for is_paper in dict.fromkeys(preset == PAPER for preset in frame["preset"]):
        colour = LIGHT if is_paper else LOOKS[models[0]][0]
        meaning = "predicted, paper preset" if is_paper else "predicted, searched preset (in the model's colour)"
        samples.append(sample(meaning, color=colour, linestyle="", marker="."))
    legend_below(figure, samples, len(samples))
    heading(figure, results, f"true and predicted {frame['coordinate'].iloc[0]}", rows_of=(TEST, EXTRAPOLATION))
    return figure


def _shown_presets(frame: pd.DataFrame, subset: str) -> set[str]:
    """The paper's preset, and the searched one that suits the subset."""
    presets = set(frame["preset"])
    return (presets & {PAPER}) | {next((preset for preset in SEARCHED_FOR[subset] if preset in presets), PAPER)}


def _draw(axes: Axes, rows: pd.DataFrame) -> None:
    """Draw one panel; predictions far beyond the true range are counted instead."""
    true = rows.drop_duplicates("place")
    low, high = true["true_mm"].min(), true["true_mm"].max()
    low, high = low - MARGIN * (high - low), high + MARGIN * (high - low)
    texts = []
    for (model, preset), part in rows.groupby(["model", "preset"], sort=False):
        colour = LIGHT if preset == PAPER else LOOKS[str(model)][0]
        axes.plot(part["place"], part["predicted_mm"], ".", color=colour, markersize=1.8, rasterized=True)
        n_off_scale = int((~part["predicted_mm"].between(low, high)).sum())
        texts += [f"{preset}: {n_off_scale} off the scale"] if n_off_scale else []
    axes.plot(true["place"], true["true_mm"], color=BLACK, linewidth=1.0)
    axes.set_ylim(low, high)
    if texts:
        axes.text(0.97, 0.03, "\n".join(texts), transform=axes.transAxes, ha="right", va="bottom", **OFF_SCALE)


FIGURE = FigureSpec(
    "position_curves",
    "Position curves",
    "True position (line) of the coordinate that moves furthest, rows sorted by it, and the predictions of each model "
    "(dots) with the paper's settings and with searched ones: on test those of the preset tuned, on extrapolation "
    "those of outer. The dots of a good model hide in the line. A plateau of dots is a model that cannot extrapolate, "
    "a band beside the line is a bias, single dots far from it are gross errors of the data or of the model.",
    frame,
    plot,
)
