"""Typical poses of the robot in space, their intervals axis by axis, and the share of rows that intervals hold."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from softkin.core.samples import TEST, TRAIN, coordinate_columns, informative_coordinates
from softkin.data.table import read_subset
from softkin.reporting.figures.reading import bounds, deployed, predicted, shown_coordinate
from softkin.reporting.figures.robot_panels import AXES, draw_intervals, draw_poses, draw_shares, missed
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import BLACK, LOOKS, PAGE, SKY, VERMILION, blank, heading, legend_below, sample
from softkin.reporting.figures.typical_poses import ranks, relative_errors, typical_poses

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 4.6


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, confidence_level, pose, error_rank, marker, error_mm, is_shown,
    true_x .. true_z, predicted_x .., lower_x .., upper_x .. (mm), is_moving_x ..: a row per marker of every row of
    `test`.

    `error_rank` is the share of rows whose error beside their interval, of the marker that moves furthest (`is_shown`),
    is smaller. `pose` is 1 to 4 for the rows that are drawn, which `typical_poses` picks, and 0 for all others.
    """
    best = deployed(results)
    if best is None:
        return pd.DataFrame()
    true = read_subset(results.table, TEST).positions
    n_markers = true.shape[1] // 3
    names = coordinate_columns(n_markers)
    guess = predicted(results, best.run, TEST, names)
    box = bounds(results, best.interval_method, best.run, best.confidence_level, names)
    assert box is not None  # a candidate has intervals
    errors = np.linalg.norm((guess - true).reshape(len(true), n_markers, 3), axis=-1)
    shown = shown_coordinate(results)[0] // 3
    is_moving = informative_coordinates(read_subset(results.table, TRAIN).positions)
    moving = 3 * shown + np.flatnonzero(is_moving[3 * shown : 3 * shown + 3])
    scores = relative_errors(true[:, moving], *(box[:, moving, side] for side in (0, 1)))
    pose = typical_poses(scores, true[:, 3 * shown : 3 * shown + 3])
    arrays = {"true": true, "predicted": guess, "lower": box[..., 0], "upper": box[..., 1]}
    arrays["is_moving"] = np.tile(is_moving, (len(true), 1))
    columns = {
        f"{name}_{axis}": array[:, i::3].ravel() for name, array in arrays.items() for i, axis in enumerate(AXES)
    }
    key = {"pose": np.repeat(pose, n_markers), "error_rank": np.repeat(ranks(scores), n_markers)}
    key |= {"marker": np.tile(np.arange(n_markers) + 1, len(true)), "error_mm": errors.ravel()}
    table = pd.DataFrame(key | columns)
    table["is_shown"] = table["marker"] == shown + 1
    of_run = {"model": best.model, "preset": best.preset, "interval_method": best.interval_method}
    return table.assign(**of_run, confidence_level=best.confidence_level)


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw the robot in space above the share of rows covered; beside them, the intervals of each pose by axis."""
    figure = blank(PAGE, HEIGHT)
    figure.set_layout_engine("none")  # it does not see labels in space
    tips = frame[frame["is_shown"]]
    first = tips.iloc[0]
    many = "" if frame["marker"].nunique() == 1 else f", marker m{first['marker']}"
    heading(figure, results, f"typical poses of test, true and predicted{many}", [TEST], rows_of=[TEST])
    top = 0.9 - 0.17 * figure.get_suptitle().count("\n") / HEIGHT
    space: Any = figure.add_subplot(projection="3d", position=(-0.02, 0.42, 0.48, top - 0.39))
    draw_poses(space, frame, results.unit)
    draw_shares(figure.add_subplot(position=(0.13, 0.16, 0.3, 0.155)), tips, frame)
    draw_intervals(figure.add_subplot(position=(0.53, 0.16, 0.45, top - 0.16)), tips, results.unit)
    colour, mark = LOOKS[first["model"]]
    look = {"linestyle": "", "markersize": 5}
    title = f"{results.model_titles[first['model']]}, {first['preset']}"
    method = results.method_titles[first["interval_method"]]
    samples = [
        sample("true", color=BLACK, marker="o", **look),
        sample(f"predicted, {title}", color=colour, marker=mark, **look),
        sample(f"{first['confidence_level']:.0%} interval, {method}", color=SKY, linewidth=5),
    ]
    if missed(tips[tips["pose"] > 0]).to_numpy().any():
        samples.append(sample("missed", color=VERMILION, marker="o", **look))
    legend_below(figure, samples, len(samples))
    return figure


FIGURE = FigureSpec(
    "robot",
    "Typical poses and their intervals",
    "Four poses of test, each typical of a quarter of the rows, from the best to the worst by their error beside their "
    "interval: in space among all true positions (grey), and axis by axis as seen from the predicted position. A black "
    "dot on its blue bar is covered, a red one beside it is missed in that axis. The bars below the robot are the "
    "share of all rows of test that are covered: those of single axes should end at the dashed line, the nominal "
    "level. All axes at once are covered less often, as each may miss in rows of its own.",
    frame,
    plot,
)
