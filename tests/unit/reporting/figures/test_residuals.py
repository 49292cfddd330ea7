"""Residuals by coordinate and marker."""

from __future__ import annotations

import numpy as np

from softkin.reporting.figures.residuals import QUANTILES, frame
from softkin.reporting.figures.spec import DatasetResults


def test_quantiles_are_of_predicted_minus_true(results: DatasetResults) -> None:
    rows = frame(results)
    assert set(zip(rows["model"], rows["preset"], strict=True)) == {("gp", "tuned")}
    assert len(rows) == 2 * 3
    for row in rows.to_dict("records"):
        expected = 3.0 if row["subset"] == "extrapolation" else 1.0
        np.testing.assert_allclose([row[name] for name in (*QUANTILES, "mean")], expected)
