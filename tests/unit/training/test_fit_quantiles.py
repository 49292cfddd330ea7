from __future__ import annotations

from pathlib import Path

import joblib
import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import read_bounds
from softkin.core.files import read_json
from softkin.core.samples import Params, Samples
from softkin.data.table import read_subset
from softkin.models.quantile import QUANTILE_MODELS
from softkin.training.fit_quantiles import QuantileFiles, QuantileModel, fit_quantiles, quantiles_of
from tests.conftest import bending_arm

LEVELS = [0.8, 0.9]
#: Where the number of trees decides nothing.
FEW_TREES = {"n_estimators": 10}


def model(name: str, samples: Samples, levels: list[float], more: Params | None = None) -> QuantileModel:
    spec = QUANTILE_MODELS[name]
    return QuantileModel(spec, spec.paper_params | (more or {}), levels, seed=0, threads=1).fit(samples)


def test_each_level_asks_for_two_quantiles_in_short_decimals() -> None:
    assert quantiles_of([0.8, 0.9, 0.95]) == [0.1, 0.9, 0.05, 0.95, 0.025, 0.975]


@pytest.mark.parametrize("name", QUANTILE_MODELS)
def test_quantiles_hold_about_their_share_of_noise(name: str) -> None:
    """Pure noise: new rows lie between the 5 % and 95 % quantiles less often than 90 %: boosting overfits."""
    rng = np.random.default_rng(0)
    rows = [Samples(rng.uniform(-1, 1, (2000, 2)), rng.standard_normal((2000, 3)) * [1, 10, 100]) for _ in range(2)]
    predicted = model(name, rows[0], [0.9]).predict(rows[1].commands)[0]
    held = (predicted[..., 0] <= rows[1].positions) & (rows[1].positions <= predicted[..., 1])
    assert held.mean(axis=0) == pytest.approx([0.84] * 3, abs=0.07)
    widths = (predicted[..., 1] - predicted[..., 0]).mean(axis=0)
    assert widths / [1, 10, 100] == pytest.approx([3.0] * 3, abs=0.5)  # mm go in and come out


@pytest.mark.parametrize("name", QUANTILE_MODELS)
def test_a_constant_coordinate_has_its_constant_as_quantiles(name: str) -> None:
    rows = bending_arm(60, n_commands=3, n_markers=2)
    predicted = model(name, rows, LEVELS, FEW_TREES).predict(rows.commands)
    assert predicted.shape == (2, 60, 6, 2)
    np.testing.assert_array_equal(predicted[:, :, :3], np.broadcast_to(rows.positions[:, :3, None], (2, 60, 3, 2)))


@pytest.mark.parametrize("name", QUANTILE_MODELS)
def test_only_train_is_fitted_on_and_files_round_trip(
    name: str, table: Path, garbage_table: Path, tmp_path: Path
) -> None:
    outputs = []
    for place, path in enumerate((table, garbage_table)):
        folder = tmp_path / str(place)
        files = QuantileFiles(folder / "m.joblib", folder / "q.parquet", folder / "r.json")
        regressor = QuantileModel(QUANTILE_MODELS[name], FEW_TREES, LEVELS, seed=0, threads=1)
        fit_quantiles(path, regressor=regressor, files=files)
        outputs.append(pd.read_parquet(files.quantiles))
        record = read_json(files.record)
        assert record["fit_seconds"] > 0
        assert record["params"] == FEW_TREES
    pd.testing.assert_frame_equal(*outputs)
    stored = joblib.load(tmp_path / "0" / "m.joblib").predict(read_subset(table, "test").commands)
    np.testing.assert_array_equal(read_bounds(outputs[0], "test", LEVELS), stored)
    assert set(outputs[0]["subset"]) == {"validation", "test", "extrapolation"}


def test_a_bound_on_the_rows_is_kept_recorded_and_said(
    table: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    predicted = []
    for place, max_rows in enumerate((15, 40)):
        files = QuantileFiles(*(tmp_path / f"{place}.{name}" for name in ("joblib", "parquet", "json")))
        regressor = QuantileModel(QUANTILE_MODELS["xgb"], FEW_TREES, LEVELS, seed=0, threads=1)
        fit_quantiles(table, regressor=regressor, files=files, max_rows=max_rows)
        assert read_json(files.record)["n_train"] == max_rows
        predicted.append(pd.read_parquet(files.quantiles))
    assert caplog.text.count("max_fit_rows") == 1
    assert "fitted on 15 of 40 rows: max_fit_rows" in caplog.text
    assert not predicted[0].equals(predicted[1])
