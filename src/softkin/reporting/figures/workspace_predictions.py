"""Workspace predictions: true and predicted positions of a marker, with intervals of some rows."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.runs import PAPERS_LEVEL, Run
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, Array, coordinate_columns
from softkin.data.table import read_subset
from softkin.models.spec import PAPERS_RUN
from softkin.reporting.figures.reading import bounds, deployed, predicted, shown_coordinate
from softkin.reporting.figures.sampling import drawn_rows
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import BLACK, LIGHT, PAGE, SUBSET_COLOURS, heading, legend_below, panels, sample

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: The interval method that is made for in-domain commands and for extrapolation.
METHOD = "auto"
#: Rows of extrapolation, and of test, whose intervals are drawn.
N_BOXES = 24
#: Inches: height around the panels, width of a panel, and greatest height.
AROUND, ACROSS, HIGHEST = 1.4, 3.1, 4.4
SHOWN, SIDES = (TEST, EXTRAPOLATION), ("lower", "upper")


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, subset, is_boxed, true_1, true_2, predicted_1, predicted_2, lower_1 ..,
    upper_2 (mm; intervals NaN where there are none), axis_1, axis_2: a row per run and drawn row of train (without
    predictions), test and extrapolation, of the marker that moves furthest, in the two coordinates of most spread.
    """
    best = deployed(results)
    runs = [run for run in dict.fromkeys([PAPERS_RUN, *([best.run] if best else [])]) if run in results.predictions]
    train = read_subset(results.table, TRAIN).positions
    first = 3 * (shown_coordinate(results)[0] // 3)
    two = first + _widest_plane(train[:, first : first + 3])
    names = [coordinate_columns(train.shape[1] // 3)[place] for place in two]
    parts = []
    for run in runs:
        for subset in (TRAIN, TEST, EXTRAPOLATION):
            true = read_subset(results.table, subset).positions[:, two]
            columns: dict[str, Any] = {"true_1": true[:, 0], "true_2": true[:, 1], "is_boxed": False}
            if subset == TRAIN:
                kept = edge_of(true)
            else:
                guess = predicted(results, run, subset, names)
                columns |= {"predicted_1": guess[:, 0], "predicted_2": guess[:, 1]}
                columns |= _intervals(results, run, subset, names)
                columns["is_boxed"] = _evenly_spread(true)
                kept = np.flatnonzero(columns["is_boxed"])
            key = {"model": run.model, "preset": run.preset, "subset": subset, "axis_1": names[0], "axis_2": names[1]}
            parts.append(pd.DataFrame(columns).iloc[drawn_rows(len(true), kept)].assign(**key))
    if not parts:
        return pd.DataFrame()
    table = pd.concat(parts, ignore_index=True)
    return table.assign(interval_method=METHOD if METHOD in results.intervals else "")


def _intervals(results: DatasetResults, run: Run, subset: str, names: list[str]) -> dict[str, Array]:
    stored = bounds(results, METHOD, run, PAPERS_LEVEL, names, subset) if METHOD in results.intervals else None
    if stored is None:
        return {}
    return {f"{side}_{n + 1}": stored[:, n, s] for n in range(2) for s, side in enumerate(SIDES)}


def edge_of(points: Array) -> NDArray[np.intp]:
    """Numbers of the corners of the convex hull of points (n_rows, 2), in order around it."""
    from scipy.spatial import ConvexHull

    return np.asarray(ConvexHull(points, qhull_options="QJ").vertices, dtype=np.intp)


def _widest_plane(points: Array) -> NDArray[np.intp]:
    """The two coordinates of points (n_rows, 3) that span the largest area."""
    spread = np.cov(points, rowvar=False)
    return np.array(max(combinations(range(3), 2), key=lambda pair: float(np.linalg.det(spread[np.ix_(pair, pair)]))))


def _evenly_spread(points: Array) -> NDArray[np.bool_]:
    """Mask (n_rows,) of points (n_rows, 2), each the farthest from those before it, the first from their mean."""
    distance = np.linalg.norm(points - points.mean(axis=0), axis=1)
    kept = np.zeros(len(points), dtype=bool)
    for _ in range(min(N_BOXES, len(points))):
        place = int(np.argmax(np.where(kept, -1.0, distance)))
        to_place = np.linalg.norm(points - points[place], axis=1)
        distance = np.minimum(distance, to_place) if kept.any() else to_place
        kept[place] = True
    return kept


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw a panel per run: the paper's, and the deployed one."""
    runs = list(frame.groupby(["model", "preset"], sort=False))
    extent = np.ptp(frame[["true_1", "true_2"]].to_numpy(), axis=0)
    height = min(AROUND + ACROSS * extent[1] / extent[0], HIGHEST)
    figure, axes = panels(1, len(runs), PAGE, height, sharex=True, sharey=True)
    for panel, ((model, preset), rows) in zip(axes[0], runs, strict=True):
        _draw(panel, rows)
        panel.set_title(f"{results.model_titles[str(model)]}, {preset}", loc="left")
        panel.set_xlabel(f"{rows['axis_1'].iloc[0]} ({results.unit})")
        panel.set_aspect("equal", adjustable="box")
    axes[0][0].set_ylabel(f"{frame['axis_2'].iloc[0]} ({results.unit})")
    samples = [
        sample("edge of train", color=BLACK, linewidth=0.8, linestyle="--"),
        sample("true", color=LIGHT, marker="o", markersize=4, linestyle=""),
        *(sample(f"predicted, {s}", color=SUBSET_COLOURS[s], marker="o", markersize=3, linestyle="") for s in SHOWN),
    ]
    if "lower_1" in frame:
        label = f"{PAPERS_LEVEL:.0%} intervals of some rows"
        samples.append(sample(label, color=BLACK, marker="s", fillstyle="none", linestyle=""))
    legend_below(figure, samples, 3)
    heading(
        figure,
        results,
        f"true and predicted positions of marker {frame['axis_1'].iloc[0].split('_')[0]}",
        rows_of=SHOWN,
    )
    return figure


def _draw(panel: Axes, rows: pd.DataFrame) -> None:
    from matplotlib.collections import LineCollection
    from matplotlib.patches import Rectangle

    train = rows.loc[rows["subset"] == TRAIN, ["true_1", "true_2"]].to_numpy()
    edge = train[edge_of(train)]
    panel.plot(*np.vstack([edge, edge[:1]]).T, color=BLACK, linewidth=0.8, linestyle="--", zorder=4)
    for subset in SHOWN:
        of_subset, colour = rows[rows["subset"] == subset], SUBSET_COLOURS[subset]
        true, guess = (of_subset[[f"{name}_1", f"{name}_2"]].to_numpy() for name in ("true", "predicted"))
        joined = np.stack([true, guess], axis=1)
        look: dict[str, Any] = {"linewidths": 0.4, "alpha": 0.5, "capstyle": "projecting", "rasterized": True}
        panel.add_collection(LineCollection(list(joined), colors=colour, zorder=2, **look))
        panel.plot(*true.T, "o", color=LIGHT, markersize=3, rasterized=True)
        panel.plot(*guess.T, "o", color=colour, markersize=1.6, rasterized=True)
        for row in of_subset[of_subset["is_boxed"]].itertuples() if "lower_1" in of_subset else ():
            size = (row.upper_1 - row.lower_1, row.upper_2 - row.lower_2)
            if np.isfinite(size).all():
                panel.add_patch(Rectangle((row.lower_1, row.lower_2), *size, fill=False, color=colour, linewidth=0.6))


FIGURE = FigureSpec(
    "workspace_predictions",
    "Workspace predictions",
    "True positions of the marker that moves furthest (grey), and those that the paper's gradient boosting and the "
    "deployed model predict (coloured); thin lines join the two. No position of train lies beyond the dashed edge. "
    "Look there: the dots of a model that extrapolates lie on the grey ones, those of one that does not pile up at the "
    "edge. The rectangles are intervals of some rows, wider in extrapolation: a good one is as small as its model "
    "allows and still holds the grey dot.",
    frame,
    plot,
)
