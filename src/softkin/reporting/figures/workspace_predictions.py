"""The workspace: where the robot is, where a model believes it to be, and how sure that is."""

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
from softkin.reporting.figures.reading import bounds, chosen, predicted, shown_coordinate
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import BLACK, LIGHT, PAGE, SUBSET_COLOURS, heading, legend_below, panels, sample

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: The interval that is made for both sides of the training shell.
METHOD = "auto"
#: Poses of extrapolation, and of test, whose interval is drawn.
N_BOXES = 24
#: Inches: around the panels, across one, and no higher than.
AROUND, ACROSS, HIGHEST = 1.4, 3.1, 4.4
SHOWN, SIDES = (TEST, EXTRAPOLATION), ("lower", "upper")


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, subset, is_boxed, true_1, true_2, predicted_1, predicted_2, lower_1 ..,
    upper_2 (mm; intervals NaN where there are none), axis_1, axis_2: a row per row of train (without predictions),
    test and extrapolation and run, of the marker that moves furthest, in the two coordinates of most spread.
    """
    best = chosen(results)
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
            if subset != TRAIN:
                mine = predicted(results, run, subset, names)
                columns |= {"predicted_1": mine[:, 0], "predicted_2": mine[:, 1]}
                columns |= _intervals(results, run, subset, two)
                columns["is_boxed"] = _evenly_spread(true)
            key = {"model": run[0], "preset": run[1], "subset": subset, "axis_1": names[0], "axis_2": names[1]}
            parts.append(pd.DataFrame(columns).assign(**key))
    if not parts:
        return pd.DataFrame()
    table = pd.concat(parts, ignore_index=True)
    return table.assign(interval_method=METHOD if METHOD in results.intervals else "")


def _intervals(results: DatasetResults, run: Run, subset: str, two: NDArray[np.intp]) -> dict[str, Array]:
    stored = bounds(results, METHOD, run, PAPERS_LEVEL, subset) if METHOD in results.intervals else None
    if stored is None:
        return {}
    return {f"{side}_{n + 1}": stored[:, place, s] for n, place in enumerate(two) for s, side in enumerate(SIDES)}


def _widest_plane(points: Array) -> NDArray[np.intp]:
    """The two coordinates of points (n_rows, 3) that span the largest area."""
    spread = np.cov(points, rowvar=False)
    return np.array(max(combinations(range(3), 2), key=lambda pair: float(np.linalg.det(spread[np.ix_(pair, pair)]))))


def _evenly_spread(points: Array) -> NDArray[np.bool_]:
    """Some points (n_rows, 2), each the farthest from those before it, the first the farthest from the middle."""
    distance = np.linalg.norm(points - points.mean(axis=0), axis=1)
    kept = np.zeros(len(points), dtype=bool)
    for _ in range(min(N_BOXES, len(points))):
        place = int(np.argmax(np.where(kept, -1.0, distance)))
        away = np.linalg.norm(points - points[place], axis=1)
        distance = away if not kept.any() else np.minimum(distance, away)
        kept[place] = True
    return kept


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """A panel per run: the paper's, and the chosen one."""
    runs = list(frame.groupby(["model", "preset"], sort=False))
    reach = np.ptp(frame[["true_1", "true_2"]].to_numpy(), axis=0)
    height = min(AROUND + ACROSS * reach[1] / reach[0], HIGHEST)
    figure, axes = panels(1, len(runs), PAGE, height, sharex=True, sharey=True)
    for panel, ((model, preset), rows) in zip(axes[0], runs, strict=True):
        _draw(panel, rows)
        panel.set_title(f"{results.model_titles[str(model)]}, {preset}", loc="left")
        panel.set_xlabel(f"{rows['axis_1'].iloc[0]} (mm)")
        panel.set_aspect("equal", adjustable="box")
    axes[0][0].set_ylabel(f"{frame['axis_2'].iloc[0]} (mm)")
    samples = [
        sample("edge of train", color=BLACK, linewidth=0.8, linestyle="--"),
        sample("true", color=LIGHT, marker="o", markersize=4, linestyle=""),
        *(sample(f"predicted, {s}", color=SUBSET_COLOURS[s], marker="o", markersize=3, linestyle="") for s in SHOWN),
    ]
    if "lower_1" in frame:
        label = f"{PAPERS_LEVEL:.0%} interval of some"
        samples.append(sample(label, color=BLACK, marker="s", fillstyle="none", linestyle=""))
    legend_below(figure, samples, 3)
    heading(figure, results, "where it is, and where believed")
    return figure


def _draw(panel: Axes, rows: pd.DataFrame) -> None:
    from matplotlib.patches import Rectangle
    from scipy.spatial import ConvexHull

    inside = rows.loc[rows["subset"] == TRAIN, ["true_1", "true_2"]].to_numpy()
    edge = inside[ConvexHull(inside, qhull_options="QJ").vertices]
    panel.plot(*np.vstack([edge, edge[:1]]).T, color=BLACK, linewidth=0.8, linestyle="--", zorder=4)
    for subset in SHOWN:
        mine, colour = rows[rows["subset"] == subset], SUBSET_COLOURS[subset]
        true, believed = (mine[[f"{name}_1", f"{name}_2"]].to_numpy() for name in ("true", "predicted"))
        panel.plot(*np.stack([true, believed], axis=1).transpose(2, 1, 0), color=colour, linewidth=0.4, alpha=0.5)
        panel.plot(*true.T, "o", color=LIGHT, markersize=3)
        panel.plot(*believed.T, "o", color=colour, markersize=1.6)
        for row in mine[mine["is_boxed"]].itertuples() if "lower_1" in mine else ():
            size = (row.upper_1 - row.lower_1, row.upper_2 - row.lower_2)
            if np.isfinite(size).all():
                panel.add_patch(Rectangle((row.lower_1, row.lower_2), *size, fill=False, color=colour, linewidth=0.6))


FIGURE = FigureSpec(
    "believed",
    "The workspace, true and predicted",
    "Where the marker that moves furthest truly is, and where two models believe it to be: the paper's gradient "
    "boosting and the chosen one. Lines join the two. Outside the dashed edge no model has seen a pose; the rectangles "
    "are intervals made for both sides of it.",
    frame,
    plot,
)
