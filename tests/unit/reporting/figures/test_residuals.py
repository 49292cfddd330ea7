"""Residuals by marker."""

from __future__ import annotations

import numpy as np

from softkin.reporting.figures.residuals import QUANTILES, frame, plot
from softkin.reporting.figures.spec import DatasetResults


def test_quantiles_are_of_predicted_minus_true(results: DatasetResults) -> None:
    rows = frame(results)
    assert set(zip(rows["model"], rows["preset"], strict=True)) == {("gp", "tuned")}
    assert len(rows) == 2 * 3
    for row in rows.to_dict("records"):
        expected = 3.0 if row["subset"] == "extrapolation" else 1.0
        np.testing.assert_allclose([row[name] for name in (*QUANTILES, "mean")], expected)


def test_constant_markers_are_left_out(results_of_many_markers: DatasetResults) -> None:
    rows = frame(results_of_many_markers)
    assert rows["marker"].unique().tolist() == ["m2", "m3"]
    panels = plot(rows, results_of_many_markers).axes
    assert [text.get_text() for text in panels[1].get_xticklabels()] == ["m2", "m3"]
    assert [axes.get_ylabel().split("\n")[0] for axes in panels] == ["test", "extrapolation"]
