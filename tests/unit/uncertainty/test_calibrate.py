from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import read_bounds
from softkin.core.runs import Run
from softkin.data.table import read_subset
from softkin.uncertainty.calibrate import calibrate
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.intervals.spec import IntervalMethod
from tests.unit.uncertainty.conftest import RUN, garbled, stored_outputs_of
from tests.unit.uncertainty.conftest import STORED_LEVELS as LEVELS


def calibrated(
    table: Path, folder: Path, method: str, output: Path, in_domain: dict[Run, IntervalMethod[Any]] | None = None
) -> pd.DataFrame:
    methods = {method: INTERVAL_METHODS[method]}
    outputs = stored_outputs_of(table, folder)
    calibrate(outputs, methods=methods, in_domain=in_domain or {}, intervals={method: output})
    return pd.read_parquet(output)


@pytest.mark.parametrize("method", INTERVAL_METHODS)
def test_every_method_fills_test_and_extrapolation_and_looks_at_no_truth_there(
    table: Path, stored: Path, method: str
) -> None:
    frame = calibrated(table, stored, method, stored / "out.parquet")
    assert list(frame.columns[:5]) == ["model", "preset", "subset", "confidence_level", "lower_m1_x"]
    for subset in ("test", "extrapolation"):
        bounds = read_bounds(frame, subset, LEVELS)
        true = read_subset(table, subset).positions
        assert bounds.shape == (2, len(true), 3, 2)
        assert ((bounds[..., 0] <= true + 1e-9) & (true <= bounds[..., 1] + 1e-9)).mean() > 0.75
    garbage = garbled(table, ("test", "extrapolation"), stored / "garbage.parquet")
    pd.testing.assert_frame_equal(frame, calibrated(garbage, stored, method, stored / "b.parquet"))


def test_a_known_residual_sets_the_width(table: Path, stored: Path) -> None:
    frame = calibrated(table, stored, "scp_mapie", stored / "out.parquet")
    width = frame["upper_m1_x"] - frame["lower_m1_x"]
    assert width.to_numpy() == pytest.approx(2.0)
    assert (frame["upper_m1_y"] - frame["lower_m1_y"]).to_numpy() == pytest.approx(0.0)


def test_the_deployed_run_has_its_own_method_in_domain(table: Path, stored: Path) -> None:
    """Here the interval of a model sure to 2 mm, far wider than split conformal prediction's."""
    output = stored / "out.parquet"
    split, own = (
        calibrated(table, stored, "auto", output, in_domain) for in_domain in ({}, {RUN: INTERVAL_METHODS["gaussian"]})
    )
    gaussian = calibrated(table, stored, "gaussian", output)
    width = [(frame["upper_m1_y"] - frame["lower_m1_y"])[frame["subset"] == "test"] for frame in (split, own, gaussian)]
    in_domain = width[0] < 1e-9
    assert in_domain.sum() > 20
    np.testing.assert_allclose(width[1][in_domain], width[2][in_domain])
    assert (width[1] >= np.maximum(width[0], width[2]) - 1e-9).all()


def test_a_model_without_a_spread_is_left_out_where_one_is_needed(table: Path, stored: Path) -> None:
    predictions = pd.read_parquet(stored / "predictions.parquet")
    predictions[["subset", "m1_x", "m1_y", "m1_z"]].to_parquet(stored / "predictions.parquet")
    assert len(calibrated(table, stored, "scp_spread", stored / "out.parquet")) == 0
    renamed = predictions.rename(columns=lambda name: name.replace("std_", "spread_"))
    renamed.to_parquet(stored / "predictions.parquet")
    assert len(calibrated(table, stored, "scp_spread", stored / "out.parquet")) > 0
    assert len(calibrated(table, stored, "gaussian", stored / "out.parquet")) == 0
