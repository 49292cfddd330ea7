"""Calibration curve."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.core.metrics.interval import coverage_band
from softkin.reporting.figures.calibration import frame
from softkin.reporting.figures.spec import DatasetResults


def test_coverage_stands_beside_its_exact_band_where_one_is_promised(results: DatasetResults) -> None:
    rows = frame(results).set_index(["interval_method", "model", "preset", "confidence_level"]).sort_index()
    shown = set(rows.index.droplevel("confidence_level"))
    around = {(method, "gb", "paper") for method in results.intervals}
    around |= {(method, "gp", "tuned") for method in ("scp_mapie", "scp_crepes", "scp_spread")}
    assert shown == around | {(method, "gb", "tuned") for method in ("qr", "cqr")}
    row = rows.loc[("scp_mapie", "gp", "tuned", 0.9)]
    assert (row["band_low"], row["band_high"]) == coverage_band(40, 40, 37)
    assert row["coverage"] == pytest.approx(0.75)
    assert row["lowest"] <= row["coverage"] <= row["highest"]
    assert np.isnan(rows.loc[("qr", "gb", "paper", 0.9), "band_low"])
