"""Interval width against error."""

from __future__ import annotations

import numpy as np
import pandas as pd

from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.figures.width import frame, plot
from tests.unit.reporting.figures.conftest import N_MISSED


def test_a_row_is_missed_where_its_error_exceeds_its_half_width(results: DatasetResults) -> None:
    rows = frame(results)
    assert rows["interval_method"].unique().tolist() == ["scp_spread", "scp_mapie", "cqr"]
    assert ((rows["error_mm"] <= rows["half_width_mm"] + 1e-9) == rows["covered"]).all()
    assert (~rows["covered"]).sum() == 3 * N_MISSED


def test_a_constant_width_is_shown_of_the_chosen_interval_alone(results: DatasetResults) -> None:
    for method in ("scp_spread", "scp_mapie"):
        stored = pd.read_parquet(results.intervals[method])
        for name in ("m1_x", "m1_y", "m1_z"):
            stored[f"upper_{name}"] = stored[f"lower_{name}"] + 2.0
        stored.to_parquet(results.intervals[method])
    rows = frame(results)
    assert rows["interval_method"].unique().tolist() == ["scp_spread", "cqr"]
    constant, varying = plot(rows, results).axes
    assert len(varying.lines) == len(constant.lines) + 1  # a constant width has no groups of like width


def test_rows_of_infinite_width_are_left_out(results: DatasetResults) -> None:
    stored = pd.read_parquet(results.intervals["scp_spread"])
    stored.loc[stored["subset"] == "test", [name for name in stored if name.startswith("upper_")]] = np.inf
    stored.to_parquet(results.intervals["scp_spread"])
    assert frame(results)["interval_method"].unique().tolist() == ["scp_mapie", "cqr"]
