"""Workspace predictions."""

from __future__ import annotations

import dataclasses

import numpy as np

from softkin.data.table import read_subset
from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.figures.workspace_predictions import N_BOXES, frame, plot


def test_the_papers_run_and_the_deployed_one_in_domain_and_in_extrapolation(results: DatasetResults) -> None:
    shown = frame(results)
    assert set(zip(shown["model"], shown["preset"], strict=True)) == {("gb", "paper"), ("gp", "tuned")}
    assert set(shown["subset"]) == {"train", "test", "extrapolation"}
    rows = shown[(shown["model"] == "gp") & (shown["subset"] == "extrapolation")]
    true = read_subset(results.table, "extrapolation").positions
    names = [f"m{place // 3 + 1}_{'xyz'[place % 3]}" for place in range(true.shape[1])]
    for n in (1, 2):
        place = names.index(rows[f"axis_{n}"].iloc[0])
        np.testing.assert_allclose(rows[f"true_{n}"], true[:, place])
    assert rows["is_boxed"].sum() == min(N_BOXES, len(rows))


def test_the_plane_is_that_of_most_spread_of_the_marker_that_moves_furthest(
    results_of_many_markers: DatasetResults,
) -> None:
    shown = frame(results_of_many_markers)
    assert (shown["axis_1"].unique().tolist(), shown["axis_2"].unique().tolist()) == (["m3_x"], ["m3_y"])


def test_rectangles_are_the_intervals_of_some_rows_and_none_where_there_are_none(results: DatasetResults) -> None:
    method = next(iter(results.intervals))
    boxed = dataclasses.replace(results, intervals={"auto": results.intervals[method]})
    shown = frame(boxed)
    assert {"lower_1", "upper_2"} <= set(shown)
    rectangles = sum(len(panel.patches) for panel in plot(shown, boxed).axes)
    assert rectangles == int((shown["is_boxed"] & shown["lower_1"].notna()).sum()) > 0
    plain = dataclasses.replace(results, intervals={method: results.intervals[method]} if method != "auto" else {})
    assert not any(panel.patches for panel in plot(frame(plain), plain).axes)
