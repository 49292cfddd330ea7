"""The paper's Figures 4 and 5."""

from __future__ import annotations

import numpy as np
import pandas as pd

from softkin.core.runs import Run
from softkin.reporting.figures.position_curves import frame, plot
from softkin.reporting.figures.spec import DatasetResults
from tests.unit.reporting.figures.conftest import OFF_MM, RUNS
from tests.unit.reporting.figures.drawn import ys


def test_every_run_is_beside_the_sorted_true_positions(results: DatasetResults) -> None:
    rows = frame(results)
    groups = rows.groupby(["model", "preset", "subset"])
    assert len(groups) == 2 * len(RUNS)
    for (model, preset, subset), group in groups:
        assert group["true_mm"].is_monotonic_increasing
        factor = 3.0 if subset == "extrapolation" else 1.0
        np.testing.assert_allclose(group["predicted_mm"] - group["true_mm"], factor * OFF_MM[Run(model, preset)])


def test_predictions_off_the_scale_are_counted(results: DatasetResults) -> None:
    rows = frame(results)
    exploded = (rows["model"] == "gp") & (rows["preset"] == "tuned") & (rows["subset"] == "test") & (rows["place"] < 7)
    rows.loc[exploded, "predicted_mm"] = 1e6
    texts = [text.get_text() for axes in plot(rows, results).axes for text in axes.texts]
    assert texts == ["tuned: 7 off the scale"]


def test_the_searched_preset_that_suits_the_subset_is_shown_and_the_legend_says_it_once(
    results: DatasetResults,
) -> None:
    rows = frame(results)
    outer = rows[rows["preset"] == "tuned"].assign(preset="outer", predicted_mm=1.0)
    figure = plot(pd.concat([rows, outer]), results)
    assert len({text.get_text() for text in figure.legends[0].texts}) == len(figure.legends[0].texts) == 3
    test, extrapolation = ([set(ys(line)) for line in figure.axes[place].lines] for place in (0, 2))
    assert {1.0} not in test
    assert {1.0} in extrapolation
    assert len(test) == len(extrapolation) == 3  # the paper's, the searched, the true one
