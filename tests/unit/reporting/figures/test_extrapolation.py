from __future__ import annotations

import numpy as np

from softkin.reporting.figures.extrapolation import MOST, frame, plot
from softkin.reporting.figures.spec import DatasetResults


def test_every_run_and_method_at_the_papers_level_those_with_labels_last(results: DatasetResults) -> None:
    shown = frame(results)
    assert set(shown["confidence_level"]) == {0.9}
    assert set(zip(shown["model"], shown["preset"], strict=True)) == {("gb", "paper"), ("gp", "tuned")}
    assert list(shown["interval_method"].unique()) == ["scp_mapie", "oracle", "weighted", "adaptive"]
    assert shown.set_index(["model", "interval_method", "subset"]).loc[("gp", "oracle", "test"), "title"] == "Oracle"


def test_dots_stand_at_coverage_and_ratio_and_a_refusal_is_told(results: DatasetResults) -> None:
    shown = frame(results)
    left, right = plot(shown, results).axes[:2]
    names = [text.get_text() for text in left.get_yticklabels()]
    row = names.index("SCP (MAPIE)")
    dots = [(*line.get_xdata(), *line.get_ydata()) for line in left.lines if len(line.get_xdata()) == 1]
    assert {x for x, y in dots if y == row} == {0.3, 0.9}
    ratios = [(*line.get_xdata(), *line.get_ydata()) for line in right.lines if len(line.get_xdata()) == 1]
    assert {x for x, y in ratios if y == names.index("Adaptive, along the way")} == {1.2, MOST}
    assert [text.get_text() for text in left.texts] == ["extrapolation: refuses"]
    assert np.isfinite([x for x, _ in ratios]).all()
