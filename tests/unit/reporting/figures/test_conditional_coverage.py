"""Conditional coverage, as a figure."""

from __future__ import annotations

import pandas as pd
import pytest
from matplotlib.collections import LineCollection
from matplotlib.container import ErrorbarContainer

from softkin.reporting.figures.conditional_coverage import PANELS, frame, plot
from softkin.reporting.figures.spec import DatasetResults
from tests.unit.reporting.figures.drawn import ys


def test_the_deployed_model_and_the_best_cqr_are_shown_and_one_library_of_two(results: DatasetResults) -> None:
    rows = frame(results)
    shown = set(rows[["model", "preset", "interval_method"]].itertuples(index=False, name=None))
    around = {("gp", "tuned", method) for method in results.intervals if method != "scp_crepes"}
    assert shown == around | {("gb", "tuned", "cqr")}
    assert set(rows["by"]) == set(PANELS)
    assert "CQR, gb tuned" in set(rows["title"])


def test_without_methods_around_a_model_cqr_is_shown_alone(results: DatasetResults) -> None:
    choice = pd.read_csv(results.choice)
    choice[choice["interval_method"] == "cqr"].to_csv(results.choice, index=False)
    assert set(frame(results)["interval_method"]) == {"cqr"}


def test_marks_stand_at_coverage_with_two_standard_errors(results: DatasetResults) -> None:
    rows = frame(results)
    drawn = plot(rows, results)
    panel = next(axes for axes in drawn.axes if axes.get_xlabel() == PANELS["marker"])
    of_marker = rows[rows["by"] == "marker"]
    shown = [bar for bar in panel.containers if isinstance(bar, ErrorbarContainer)]
    assert [ys(bar.lines[0])[0] for bar in shown if bar.lines[0]] == pytest.approx(of_marker["coverage"].tolist())
    [ends] = shown[0].lines[2]
    assert isinstance(ends, LineCollection)
    low, high = ends.get_segments()[0][:, 1]
    assert high - low == pytest.approx(4 * of_marker["standard_error"].iloc[0])
    assert [text.get_text() for text in panel.get_xticklabels()] == ["m1"]
    assert 0.9 in [ys(line)[0] for line in panel.lines]
