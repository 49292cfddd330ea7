"""Errors by the share of train."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, coordinate_columns
from softkin.data.table import to_table, write_table
from softkin.evaluation.learning_curve import COLUMNS, DRAWS, FittedRun, learning_curve
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings
from tests.conftest import four_subsets


def test_errors_shrink_with_the_share_and_the_last_is_that_of_the_run(tmp_path: Path) -> None:
    samples = four_subsets({**dict.fromkeys(SUBSETS, 40), "train": 200})
    write_table(to_table(samples), tmp_path / "table.parquet")
    stored = [
        pd.DataFrame(rows.positions + 0.25, columns=coordinate_columns(1)).assign(subset=subset)
        for subset, rows in samples.items()
    ]
    pd.concat(stored).to_parquet(tmp_path / "predictions.parquet")
    runs = {
        Run(name, "paper"): FittedRun(
            MODELS[name], FitSettings(MODELS[name].paper_params, True, 0, 1), tmp_path / "predictions.parquet"
        )
        for name in ("svr", "lr")
    }
    learning_curve(tmp_path / "table.parquet", dataset="arm", runs=runs, output=tmp_path / "curve.csv")
    frame = pd.read_csv(tmp_path / "curve.csv")
    assert list(frame.columns) == COLUMNS
    of_svr = frame[frame["model"] == "svr"].set_index("share")
    assert of_svr["n_rows"].tolist() == [10, 20, 50, 200]
    assert of_svr["n_draws"].tolist() == [*DRAWS.values(), 1]
    assert of_svr.loc[0.05, "rmse_mm"] > of_svr.loc[0.25, "rmse_mm"]
    np.testing.assert_allclose(frame.loc[frame["share"] == 1, ["rmse_mm", "mae_mm"]], 0.25)


def test_a_model_that_cannot_be_fitted_to_a_part_is_named(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """Tables can be made without it, see `failed_parts`."""
    write_table(to_table(four_subsets(dict.fromkeys(SUBSETS, 40))), tmp_path / "table.parquet")
    settings = FitSettings({"degree": "none"}, True, 0, 1)
    runs = {Run("lr", "paper"): FittedRun(MODELS["lr"], settings, tmp_path / "predictions.parquet")}
    with pytest.raises(TypeError, match="unsupported"):
        learning_curve(tmp_path / "table.parquet", dataset="arm", runs=runs, output=tmp_path / "curve.csv")
    assert "the job failed on the model lr" in caplog.text
