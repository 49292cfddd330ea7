"""Panels of the figure of the robot."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba

from softkin.reporting.figures.robot_panels import draw_intervals, draw_poses, draw_shares, missed, shown_unit
from softkin.reporting.figures.style import BLACK, VERMILION, blank, panels
from tests.unit.reporting.figures.drawn import bars, marks, xs


def markers(n_markers: int = 1, n_rows: int = 4) -> pd.DataFrame:
    """Rows whose true position is 1, 2, .. mm off in x, with intervals of 2.5 mm to either side."""
    rows = pd.DataFrame({"pose": np.repeat(np.arange(n_rows) + 1, n_markers)})
    rows["marker"] = np.tile(np.arange(n_markers) + 1, n_rows)
    rows["error_rank"] = (rows["pose"] - 1) / 3
    rows["error_mm"] = 1.0 * rows["pose"]
    for place, axis in enumerate("xyz"):
        rows[f"predicted_{axis}"] = 10.0 * rows["marker"] + 5.0 * place * rows["pose"]
        rows[f"true_{axis}"] = rows[f"predicted_{axis}"] + (rows["pose"] if axis == "x" else 0.0)
        rows[f"lower_{axis}"] = rows[f"predicted_{axis}"] - 2.5
        rows[f"upper_{axis}"] = rows[f"predicted_{axis}"] + 2.5
        rows[f"is_moving_{axis}"] = True
    names = {"model": "gp", "preset": "tuned", "interval_method": "scp_mapie", "confidence_level": 0.9}
    return rows.assign(is_shown=rows["marker"] == n_markers, **names)


def drawn_intervals(rows: pd.DataFrame) -> Axes:
    _, [[axes]] = panels(1, 1, 4.0, 4.0)
    draw_intervals(axes, rows, "mm")
    return axes


def dots(axes: Axes, colour: str) -> list[float]:
    """Where the true positions of this colour are drawn."""
    return [xs(line)[0] for line in marks(axes) if line.get_color() == colour]


def test_a_row_is_missed_in_the_axes_whose_interval_does_not_hold_it() -> None:
    rows = markers()
    assert missed(rows)["x"].tolist() == [False, False, True, True]
    assert not missed(rows)[["y", "z"]].to_numpy().any()
    assert not missed(rows.assign(is_moving_x=False)).to_numpy().any()


def test_misses_are_marked_in_their_axis_and_named() -> None:
    axes = drawn_intervals(markers())
    assert dots(axes, VERMILION) == [3.0, 4.0]
    assert sorted(dots(axes, BLACK)) == [0.0] * 8 + [1.0, 2.0]
    texts = [text.get_text() for text in axes.texts]
    quarters = ["best quarter", "second quarter", "third quarter", "worst quarter"]
    assert texts[::2] == [f"pose {n}: {n}.00 mm off, {quarter}" for n, quarter in enumerate(quarters, 1)]
    assert texts[1::2] == ["covered", "covered", "missed in x", "missed in x"]


def test_bars_are_the_intervals_as_seen_from_the_predicted_position() -> None:
    assert set(bars(drawn_intervals(markers()))) == {(-2.5, 2.5)}


def test_a_constant_axis_has_no_bar() -> None:
    axes = drawn_intervals(markers().assign(is_moving_z=False))
    assert len(axes.patches) == 4 * 2
    assert {text.get_text() for text in axes.get_yticklabels()} == {"x", "y"}


def test_a_true_position_far_off_is_an_arrow_with_its_distance() -> None:
    rows = markers()
    rows.loc[3, "true_x"] = rows.loc[3, "predicted_x"] - 80.0
    axes = drawn_intervals(rows)
    assert "-80" in [text.get_text() for text in axes.texts]
    arrow = next(line for line in axes.lines if line.get_marker() == "<")
    assert axes.get_xlim()[0] < xs(arrow)[0] < -2.5
    assert axes.get_xlim()[1] < 10.0


def test_infinite_intervals_fill_the_panel_and_cover() -> None:
    rows = markers()
    for axis in "xyz":
        rows[f"lower_{axis}"], rows[f"upper_{axis}"] = -np.inf, np.inf
    axes = drawn_intervals(rows)
    assert set(bars(axes)) == {axes.get_xlim()}
    assert dots(axes, VERMILION) == []


@pytest.mark.parametrize(("factor", "unit"), [(1.0, "mm"), (1e-3, "µm"), (1e-6, "nm"), (1e-12, "pm")])
def test_lengths_are_in_a_fitting_unit(factor: float, unit: str) -> None:
    lengths = factor * np.array([3.0, 0.1, np.inf, np.nan])
    assert shown_unit(lengths, "mm")[0] == unit
    assert shown_unit(lengths, "px") == ("px", 1.0)
    rows = markers()
    for axis in "xyz":
        for name in ("true", "lower", "upper"):
            offset = rows[f"{name}_{axis}"] - rows[f"predicted_{axis}"]
            rows[f"{name}_{axis}"] = offset * factor
        rows[f"predicted_{axis}"] = 0.0
    assert drawn_intervals(rows).get_xlabel() == f"distance from the predicted position ({unit})"


def test_shares_are_of_all_rows_by_axis_at_once_and_over_all_markers() -> None:
    rows = markers(n_markers=2)
    rows.loc[0, "true_y"] += 100.0  # of the marker that is not shown
    rows.loc[1, "true_z"] += 100.0
    _, [[axes]] = panels(1, 1, 4.0, 2.0)
    draw_shares(axes, rows[rows["is_shown"]], rows)
    names = [text.get_text() for text in axes.get_yticklabels()]
    shares = dict(zip(names, [right for _, right in bars(axes)], strict=True))
    assert shares == {"x": 0.5, "y": 1.0, "z": 0.75, "x, y, z": 0.25, "all markers": 0.25}
    assert [text.get_text() for text in axes.texts] == ["50%", "100%", "75%", "25%", "25%"]
    assert xs(axes.lines[0])[0] == 0.9


def test_a_single_marker_has_a_stem_and_several_are_joined() -> None:
    for n_markers, n_stems in ((1, 4), (3, 0)):
        axes = blank(4.0, 4.0).add_subplot(projection="3d")
        draw_poses(axes, markers(n_markers), "mm")
        assert len([line for line in axes.lines if line.get_marker() == "x"]) == n_stems
        joined = [line for line in axes.lines if line.get_color() == BLACK]
        assert {len(line.get_data_3d()[0]) for line in joined} == {n_markers}
        assert [text.get_text().strip() for text in axes.texts] == ["1", "2", "3", "4"]


def test_boxes_are_drawn_where_they_can_be_seen() -> None:
    for factor, n_boxes in ((1.0, 4), (1e-4, 0)):
        rows = markers()
        for axis in "xyz":
            for end in ("lower", "upper"):
                rows[f"{end}_{axis}"] = rows[f"predicted_{axis}"] + factor * (
                    rows[f"{end}_{axis}"] - rows[f"predicted_{axis}"]
                )
        axes = blank(4.0, 4.0).add_subplot(projection="3d")
        draw_poses(axes, rows, "mm")
        assert len(axes.collections) == n_boxes
        assert to_rgba(BLACK) not in [tuple(box.get_edgecolor()[0]) for box in axes.collections]
