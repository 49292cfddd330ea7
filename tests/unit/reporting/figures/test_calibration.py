"""Calibration curve."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from softkin.core.metrics.interval import coverage_band
from softkin.reporting.figures.calibration import frame, plot
from softkin.reporting.figures.spec import DatasetResults


def test_coverage_stands_beside_its_exact_band_where_one_is_guaranteed(results: DatasetResults) -> None:
    rows = frame(results).set_index(["interval_method", "model", "preset", "confidence_level"]).sort_index()
    shown = set(rows.index.droplevel("confidence_level"))
    expected = {(method, "gb", "paper") for method in results.intervals}
    expected |= {(method, "gp", "tuned") for method in ("scp_mapie", "scp_crepes", "scp_spread")}
    assert shown == expected | {(method, "gb", "tuned") for method in ("qr", "cqr")}
    row = rows.loc[("scp_mapie", "gp", "tuned", 0.9)]
    assert (row["band_low"], row["band_high"]) == coverage_band(40, 40, 37)
    assert row["coverage"] == pytest.approx(0.75)
    assert row["lowest"] <= row["coverage"] <= row["highest"]
    assert np.isnan(rows.loc[("qr", "gb", "paper", 0.9), "band_low"])


def test_constant_coordinates_have_no_part_in_the_range(results_of_many_markers: DatasetResults) -> None:
    metrics = pd.read_csv(results_of_many_markers.interval_metrics)
    metrics.loc[metrics["coordinate"].str.startswith("m1_"), "coverage"] = 0.0
    metrics.to_csv(results_of_many_markers.interval_metrics, index=False)
    assert (frame(results_of_many_markers)["lowest"] == 0.75).all()


def test_each_method_has_a_panel_with_the_nominal_level(results: DatasetResults) -> None:
    drawn = plot(frame(results), results)
    panels = [axes for axes in drawn.axes if axes.get_title()]
    assert [axes.get_title() for axes in panels] == [results.method_titles[name] for name in results.intervals]
    for axes in panels:
        np.testing.assert_array_equal(axes.lines[0].get_xdata(), axes.lines[0].get_ydata())
