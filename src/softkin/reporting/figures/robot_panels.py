"""Panels of the figure of the robot: poses in space, intervals of a marker axis by axis, shares of rows covered."""

from __future__ import annotations

from itertools import combinations, product
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from softkin.core.samples import Array
from softkin.core.units import MM
from softkin.reporting.figures.sampling import drawn_rows
from softkin.reporting.figures.style import BLACK, GREY, LEAST_MM, LIGHT, LOOKS, SKY, VERMILION
from softkin.reporting.tables.numbers import number_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AXES = "xyz"
ENDS = ("lower", "upper")
#: Of lengths, and how many of each a mm has.
UNITS = {MM: 1.0, "µm": 1e3, "nm": 1e6, "pm": 1e9}
#: The corners of a box, and its edges: two corners that differ in one coordinate.
CORNERS = list(product((0, 1), repeat=3))
EDGES = [(a, b) for a, b in combinations(CORNERS, 2) if sum(i != j for i, j in zip(a, b, strict=True)) == 1]
#: A true position further off than this many times the largest bound is drawn at the edge, with its distance.
MOST_BOUNDS = 2.0
#: By the share of rows that are better than a row.
QUARTERS = ("best quarter", "second quarter", "third quarter", "worst quarter", "worst quarter")
#: Between the bars of two poses, in bars.
GAP = 1.6
#: A box smaller than this share of the workspace is not drawn in space: it would hide in its mark.
LEAST_SHARE = 0.01


def missed(rows: pd.DataFrame) -> pd.DataFrame:
    """Whether the interval of a moving coordinate misses the true position: columns x, y, z, a row per row."""
    holds = {axis: rows[f"true_{axis}"].between(rows[f"lower_{axis}"], rows[f"upper_{axis}"]) for axis in AXES}
    return pd.DataFrame({axis: rows[f"is_moving_{axis}"] & ~holds[axis] for axis in AXES})


def shown_unit(lengths: Array, unit: str) -> tuple[str, float]:
    """The largest unit in which the largest finite length is at least 1, and how many of it a mm has; a unit
    that is not mm has no smaller ones.
    """
    if unit != MM:
        return unit, 1.0
    finite = lengths[np.isfinite(lengths)]
    largest = float(np.abs(finite).max(initial=0.0))
    return next((item for item in UNITS.items() if largest * item[1] >= 1.0), ("pm", UNITS["pm"]))


def draw_poses(axes: Any, frame: pd.DataFrame, unit: str) -> None:
    """Draw true and predicted markers of the poses, their boxes where large enough, and all true positions in grey.

    The markers of a pose are joined along the robot; the pose of a single marker has a stem down to the floor.
    """
    colour, mark = LOOKS[frame["model"].iloc[0]]
    tips = frame[frame["is_shown"]]
    drawn = tips.iloc[drawn_rows(len(tips))]
    axes.plot(*(drawn[f"true_{axis}"] for axis in AXES), "o", color=LIGHT, markersize=2.2, markeredgewidth=0)
    extent = np.array([np.ptp(frame[f"true_{axis}"]) for axis in AXES])
    floor = frame["true_z"].min() - 0.1 * extent[2]
    for pose, rows in frame[frame["pose"] > 0].groupby("pose"):
        true, guess = (rows[[f"{name}_{axis}" for axis in AXES]].to_numpy() for name in ("true", "predicted"))
        if len(true) == 1:
            axes.plot(*np.vstack([true, [*true[0, :2], floor]]).T, color=GREY, linewidth=0.7)
            axes.plot(*true[0, :2], floor, "x", color=GREY, markersize=3, markeredgewidth=0.7)
        axes.plot(*true.T, "o-", color=BLACK, markersize=3.5, linewidth=1.0)
        axes.plot(*guess.T, mark, color=colour, markersize=3)
        for corners in _boxes(rows, LEAST_SHARE * extent.max()):
            axes.add_collection3d(_wires(corners))
        tip = rows[rows["is_shown"]].iloc[0]
        axes.text(*(tip[f"true_{axis}"] for axis in AXES), f"  {pose}", fontsize=9, va="bottom", zorder=10)
    axes.set_zlim(floor, frame["true_z"].max())
    shape = np.maximum(extent, 0.4 * extent.max())
    axes.set_box_aspect(shape, zoom=0.95 if shape[2] == shape.max() else 1.12)
    _label(axes, unit)


def draw_intervals(axes: Axes, tips: pd.DataFrame, own_unit: str) -> None:
    """Draw a group of bars for each pose: the interval of each moving axis as seen from the predicted position."""
    rows = tips[tips["pose"] > 0].sort_values("pose")
    moving = [axis for axis in AXES if rows[f"is_moving_{axis}"].all()]
    columns = {name: rows[[f"{name}_{axis}" for axis in moving]].to_numpy() for name in (*ENDS, "true", "predicted")}
    lengths = np.concatenate([columns[name] - columns["predicted"] for name in ("true", "upper")])
    unit, factor = shown_unit(lengths, own_unit)
    true, *ends = (factor * (columns[name] - columns["predicted"]) for name in ("true", *ENDS))
    limit = _limit(true, np.stack(ends))
    bounds = np.clip(np.stack(ends, axis=-1), -limit, limit)
    is_missed = missed(rows)[moving].to_numpy()
    colour, heights = LOOKS[rows["model"].iloc[0]][0], []
    for place, row in enumerate(rows.itertuples()):
        top = -place * (len(moving) + GAP)
        missed_axes = [axis for axis, off in zip(moving, is_missed[place], strict=True) if off]
        _head(axes, row, top, missed_axes, f"{number_text(row.error_mm * factor)} {unit}")
        for i in range(len(moving)):
            heights.append(top - 1.0 - i)
            _bar(axes, heights[-1], bounds[place, i], true[place, i], limit, is_missed=bool(is_missed[place, i]))
        axes.vlines(0.0, heights[-1] - 0.45, top - 0.55, color=colour, linewidth=1.2, zorder=2)
    axes.set(
        xlim=(-limit, limit), ylim=(heights[-1] - 0.8, 0.7), xlabel=f"distance from the predicted position ({unit})"
    )
    axes.set_yticks(heights, moving * len(rows))
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")
    axes.spines["left"].set_visible(False)


def _limit(true: Array, bounds: Array) -> float:
    """How far the panel extends to either side: all bounds, and true positions that are not too far beyond them."""
    largest, finite = float(np.abs(true).max()), np.abs(bounds[np.isfinite(bounds)])
    if len(finite):
        largest = max(float(finite.max()), min(largest, MOST_BOUNDS * float(finite.max())))
    return 1.12 * max(largest, LEAST_MM)


def draw_shares(axes: Axes, tips: pd.DataFrame, frame: pd.DataFrame) -> None:
    """Draw the share of rows that intervals hold: of each axis of the shown marker, all at once, and all markers."""
    is_missed, moving = missed(tips), [axis for axis in AXES if tips[f"is_moving_{axis}"].all()]
    shares = {axis: 1.0 - is_missed[axis].mean() for axis in moving}
    if len(moving) > 1:
        shares[", ".join(moving)] = 1.0 - is_missed.any(axis=1).mean()
    n_markers = frame["marker"].nunique()
    if n_markers > 1:
        of_rows = missed(frame).any(axis=1).to_numpy().reshape(-1, n_markers).any(axis=1)
        shares["all markers"] = 1.0 - of_rows.mean()
    heights = range(len(shares))
    colours = [SKY if name in AXES else GREY for name in shares]
    axes.barh(heights, list(shares.values()), 0.62, color=colours)
    for height, (name, share) in enumerate(shares.items()):
        axes.text(0.02, height, f"{share:.0%}", va="center", fontsize=7, color="white" if name not in AXES else BLACK)
    axes.axvline(tips["confidence_level"].iloc[0], color=BLACK, linewidth=0.8, linestyle="--")
    axes.set(xlim=(0, 1), ylim=(len(shares) - 0.5, -0.6))
    axes.set_title(f"share of all {len(tips)} rows covered", fontsize=8, loc="left")
    axes.set_xticks([0, 0.5, tips["confidence_level"].iloc[0]], ["0", "50%", f"{tips['confidence_level'].iloc[0]:.0%}"])
    axes.set_yticks(heights, list(shares), fontsize=8)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False)


def _head(axes: Axes, row: Any, height: float, missed_axes: list[str], error: str) -> None:
    """Write the number of a pose, its error, and in which axes it is missed above its bars."""
    look: dict[str, Any] = {"transform": axes.get_yaxis_transform(), "va": "center", "fontsize": 8}
    axes.text(0.0, height, f"pose {row.pose}: {error} off, {QUARTERS[int(4 * row.error_rank)]}", **look)
    verdict = f"missed in {' and '.join(missed_axes)}" if missed_axes else "covered"
    axes.text(1.0, height, verdict, ha="right", color=VERMILION if missed_axes else BLACK, **look)


def _bar(axes: Axes, height: float, ends: Array, true: float, limit: float, *, is_missed: bool) -> None:
    """Draw one interval and its true position; beyond the edge, an arrow there with the distance."""
    axes.barh(height, ends[1] - ends[0], 0.62, left=ends[0], color=SKY, alpha=0.75, zorder=1)
    colour = VERMILION if is_missed else BLACK
    if abs(true) <= limit:
        axes.plot(true, height, "o", color=colour, markersize=4.5, zorder=3)
        return
    side = np.sign(true)
    axes.plot(side * 0.98 * limit, height, ">" if side > 0 else "<", color=colour, markersize=4.5, zorder=3)
    look: dict[str, Any] = {"ha": "right" if side > 0 else "left", "va": "center", "fontsize": 7, "color": colour}
    axes.text(side * 0.94 * limit, height, f"{true:.3g}", **look)


def _boxes(rows: pd.DataFrame, least: float) -> list[Array]:
    """Lower and upper corner (2, 3) of each marker whose intervals are finite and somewhere wider than `least`."""
    ends = [rows[[f"{name}_{axis}" for axis in AXES]].to_numpy() for name in ("lower", "upper")]
    corners = np.stack(ends, axis=1)
    return [box for box in corners if np.isfinite(box).all() and np.ptp(box, axis=0).max() >= least]


def _wires(corners: Array) -> Any:
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    lines = [[[corners[end[i]][i] for i in range(3)] for end in edge] for edge in EDGES]
    return Line3DCollection(lines, colors=SKY, linewidths=1.0)


def _label(axes: Any, unit: str) -> None:
    from matplotlib.ticker import MaxNLocator

    for name in AXES:
        axis = getattr(axes, f"{name}axis")
        axis.set_major_locator(MaxNLocator(3))
        axis.set_tick_params(labelsize=6.5, pad={"x": -2, "y": 0, "z": 2}[name])
        axis.set_label_text(f"{name} ({unit})", fontsize=7.5)
        axis.labelpad = {"x": -5, "y": -2, "z": 0}[name]
