"""The robot in space: true and predicted markers of a few poses, and the box of their intervals."""

from __future__ import annotations

from itertools import combinations, product
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from softkin.core.samples import TEST, Array, coordinate_columns
from softkin.data.table import read_subset
from softkin.reporting.figures.reading import bounds, chosen, predicted, shown_coordinate
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import (
    BLACK,
    LEAST_MM,
    LIGHT,
    LOOKS,
    PAGE,
    SKY,
    blank,
    heading,
    legend_below,
    sample,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Poses from the least to the furthest reached position of the coordinate that moves furthest.
PLACES = (0.02, 0.35, 0.65, 0.98)
HEIGHT = 4.4
UNITS = {"mm": 1.0, "µm": 1e3, "nm": 1e6, "pm": 1e9}
#: A pose in space, and the edges between two corners of a box that differ in one coordinate.
CORNERS = list(product((0, 1), repeat=3))
EDGES = [(a, b) for a, b in combinations(CORNERS, 2) if sum(i != j for i, j in zip(a, b, strict=True)) == 1]
AXES = "xyz"


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, confidence_level, pose, marker, true_x .. true_z, predicted_x ..,
    lower_x .., upper_x .. (mm): a row per marker of every row of `test`, `pose` 1 to 4 of those that are shown at
    length and 0 of the others, of which only the true positions are drawn.
    """
    best = chosen(results)
    if best is None:
        return pd.DataFrame()
    true = read_subset(results.table, TEST).positions
    n_markers = true.shape[1] // 3
    mine = predicted(results, best.run, TEST, coordinate_columns(n_markers))
    box = bounds(results, best.interval_method, best.run, best.confidence_level)
    assert box is not None  # a candidate has intervals
    order = np.argsort(true[:, shown_coordinate(results)[0]], kind="stable")
    pose = np.zeros(len(true), dtype=int)
    pose[order[[int(place * (len(true) - 1)) for place in PLACES]]] = np.arange(len(PLACES)) + 1
    named = {"true": true, "predicted": mine, "lower": box[..., 0], "upper": box[..., 1]}
    columns = {f"{name}_{axis}": array[:, i::3].ravel() for name, array in named.items() for i, axis in enumerate(AXES)}
    key = {"pose": np.repeat(pose, n_markers), "marker": np.tile(np.arange(n_markers) + 1, len(true))}
    table = pd.DataFrame(key | columns)
    names = {"model": best.model, "preset": best.preset, "interval_method": best.interval_method}
    return table.assign(**names, confidence_level=best.confidence_level)


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Left the whole robot; right, for each pose, the marker that moves furthest, seen from its predicted position."""
    first = frame.iloc[0]
    figure = blank(PAGE, HEIGHT)
    figure.set_layout_engine("none")  # it knows nothing of labels in space
    marker = int(shown_coordinate(results)[0] // 3 + 1)
    heading(figure, results, f"poses of test, marker m{marker} close up")
    n_more_lines = figure.get_suptitle().count("\n")
    free = 0.85 - 0.17 * n_more_lines / HEIGHT
    whole: Any = figure.add_subplot(projection="3d", position=(0.01, 0.09, 0.43, free))
    _robot(whole, frame, marker)
    shown = frame[(frame["marker"] == marker) & (frame["pose"] > 0)].sort_values("pose")
    for place, row in enumerate(shown.itertuples()):
        unit, factor = _unit(shown.iloc[[place]])
        position = (0.46 + 0.255 * (place % 2), 0.09 + free * (0.5 - 0.5 * (place // 2)), 0.25, 0.47 * free)
        axes: Any = figure.add_subplot(projection="3d", position=position)
        is_covered = _tip(axes, row, unit, factor)
        axes.set_title(f"pose {row.pose}, {'covered' if is_covered else 'missed'}", fontsize=8, y=0.97)
    colour, mark = LOOKS[first["model"]]
    title = f"{results.model_titles[first['model']]}, {first['preset']}"
    method = results.method_titles[first["interval_method"]]
    look = {"linestyle": "", "markersize": 5}
    samples = [
        sample("true", color=BLACK, marker="o", **look),
        sample(f"predicted ({title})", color=colour, marker=mark, **look),
        sample(f"{first['confidence_level']:.0%} intervals ({method})", color=SKY, linewidth=2),
    ]
    legend_below(figure, samples, 3)
    return figure


def _robot(axes: Any, frame: pd.DataFrame, marker: int) -> None:
    colour, mark = LOOKS[frame["model"].iloc[0]]
    others = frame[frame["marker"] == marker]
    axes.plot(others["true_x"], others["true_y"], others["true_z"], ".", color=LIGHT, markersize=1.5)
    for pose, rows in frame[frame["pose"] > 0].groupby("pose"):
        true, guess = ([rows[f"{name}_{axis}"].to_numpy() for axis in AXES] for name in ("true", "predicted"))
        axes.plot(*true, "o-", color=BLACK, markersize=3.5, linewidth=1.0)
        axes.plot(*guess, mark, color=colour, markersize=3)
        for corners in _boxes(rows):
            axes.add_collection3d(_box(corners))
        tip = rows[rows["marker"] == marker].iloc[0]
        axes.text(*(tip[f"true_{axis}"] for axis in AXES), f"  {pose}", fontsize=9, va="bottom")
    ranges = np.array([np.ptp(frame[f"true_{axis}"]) for axis in AXES])
    axes.set_box_aspect(np.maximum(ranges, 0.4 * ranges.max()), zoom=0.8)
    _label(axes, [f"{axis} (mm)" for axis in AXES])


def _tip(axes: Any, row: Any, unit: str, factor: float) -> bool:
    """Draw one marker; whether its box holds the true position."""
    colour, mark = LOOKS[row.model]
    centre = np.array([getattr(row, f"predicted_{axis}") for axis in AXES])
    true, lower, upper = (
        factor * (np.array([getattr(row, f"{name}_{axis}") for axis in AXES]) - centre)
        for name in ("true", "lower", "upper")
    )
    if np.isfinite([lower, upper]).all():
        axes.add_collection3d(_box(np.stack([lower, upper])))
    axes.plot(*true[:, None], "o", color=BLACK, markersize=4)
    axes.plot([0], [0], [0], mark, color=colour, markersize=4)
    ends = np.stack([true, np.zeros(3), *(end for end in (lower, upper) if np.isfinite(end).all())])
    reach = 1.1 * np.maximum(np.abs(ends).max(axis=0), 1e-3 * np.abs(ends).max() + LEAST_MM)
    axes.set(xlim=(-reach[0], reach[0]), ylim=(-reach[1], reach[1]), zlim=(-reach[2], reach[2]))
    axes.set_box_aspect((1, 1, 1), zoom=0.75)
    _label(axes, [f"{axis} ({unit})" for axis in AXES])
    return bool(((lower <= true) & (true <= upper)).all())


def _label(axes: Any, labels: list[str]) -> None:
    from matplotlib.ticker import MaxNLocator

    for name, label in zip(AXES, labels, strict=True):
        axis = getattr(axes, f"{name}axis")
        axis.set_major_locator(MaxNLocator(3))
        axis.set_tick_params(labelsize=6.5, pad={"x": -2, "y": 0, "z": 2}[name])
        axis.set_label_text(label, fontsize=7.5)
        axis.labelpad = {"x": -5, "y": -2, "z": 0}[name]


def _unit(rows: pd.DataFrame) -> tuple[str, float]:
    """The largest unit in which what is seen has a whole number of them, and how many of it a mm has."""
    sizes = [(rows[f"{name}_{axis}"] - rows[f"predicted_{axis}"]).abs() for name in ("true", "upper") for axis in AXES]
    finite = np.concatenate(sizes)
    largest = float(finite[np.isfinite(finite)].max())
    return next((item for item in UNITS.items() if largest * item[1] >= 1.0), ("pm", UNITS["pm"]))


def _boxes(rows: pd.DataFrame) -> list[Array]:
    """Lower and upper corner (2, 3) of each marker whose intervals are finite; mm."""
    corners = [rows[[f"{name}_{axis}" for axis in AXES]].to_numpy() for name in ("lower", "upper")]
    stacked = np.stack(corners, axis=1)
    return list(stacked[np.isfinite(stacked).all(axis=(1, 2))])


def _box(corners: Array) -> Any:
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    lines = [[[corners[end[i]][i] for i in range(3)] for end in edge] for edge in EDGES]
    return Line3DCollection(lines, colors=SKY, linewidths=1.0)


FIGURE = FigureSpec(
    "robot",
    "Poses and their intervals",
    "Left: true and predicted markers of four poses of test, and all true positions of the marker that moves furthest. "
    "Right: that marker as seen from its predicted position, with the box of its three intervals.",
    frame,
    plot,
)
