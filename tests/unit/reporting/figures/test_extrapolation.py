"""Intervals in extrapolation, as a figure."""

from __future__ import annotations

import numpy as np
import pandas as pd

from softkin.reporting.figures.extrapolation import MOST, frame, plot
from softkin.reporting.figures.spec import DatasetResults
from softkin.uncertainty.labelled import LABELLED_METHODS
from tests.unit.reporting.figures.drawn import marks, xs, ys


def test_every_run_and_method_at_the_papers_level_labelled_ones_last(results: DatasetResults) -> None:
    shown = frame(results)
    assert set(shown["confidence_level"]) == {0.9}
    assert set(zip(shown["model"], shown["preset"], strict=True)) == {("gb", "paper"), ("gp", "tuned")}
    assert list(shown["interval_method"].unique()) == ["scp_mapie", "oracle", "weighted", "adaptive"]
    assert shown.set_index(["model", "interval_method", "subset"]).loc[("gp", "oracle", "test"), "title"] == "Oracle"


def test_dots_stand_at_coverage_and_ratio_and_a_refusal_is_written(results: DatasetResults) -> None:
    shown = frame(results)
    left, right = plot(shown, results).axes[:2]
    names = [text.get_text() for text in left.get_yticklabels()]
    row = names.index("SCP (MAPIE)")
    dots = [(*xs(mark), *ys(mark)) for mark in marks(left)]
    assert {x for x, y in dots if y == row} == {0.3, 0.9}
    ratios = [(*xs(mark), *ys(mark)) for mark in marks(right)]
    adaptive = names.index(LABELLED_METHODS["adaptive"].title)
    assert {x for x, y in ratios if y == adaptive} == {1.2, MOST}
    assert [text.get_text() for text in left.texts] == ["extrapolation: refuses"]
    assert np.isfinite([x for x, _ in ratios]).all()


def test_labelled_methods_are_diamonds(results: DatasetResults) -> None:
    left = plot(frame(results), results).axes[0]
    names = [text.get_text() for text in left.get_yticklabels()]
    looks = {names[int(ys(mark)[0])]: mark.get_marker() for mark in marks(left)}
    assert (looks["SCP (MAPIE)"], looks["Oracle"]) == ("o", "D")


def test_without_scores_there_is_nothing_to_draw(results: DatasetResults) -> None:
    pd.read_csv(results.extrapolation).head(0).to_csv(results.extrapolation, index=False)
    assert frame(results).empty
