from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pytest

from softkin.core.files import read_json
from softkin.core.samples import SUBSETS, TRAIN, Samples
from softkin.data.table import read_subset, to_table, write_table
from softkin.models import MODELS
from softkin.training.fit import FitFiles, fit, fit_each
from softkin.training.kinematic_model import FitSettings, fit_quietly, fitted_model, recorded_settings
from tests.conftest import bending_arm

SETTINGS = FitSettings({}, skip_constant=False, seed=0, threads=1)
PROBE = bending_arm(9, seed=7).commands


def run(
    table: Path, folder: Path, model: str = "lr", settings: FitSettings = SETTINGS, max_rows: int | None = None
) -> Path:
    """Fit, and return the folder of the files."""
    folder.mkdir(exist_ok=True)
    files = FitFiles(folder / "model.joblib", folder / "fit.json", folder / "predictions.parquet")
    fit(table, spec=MODELS[model], settings=settings, files=files, max_rows=max_rows)
    return folder


def test_the_stored_model_is_the_one_of_its_settings_on_train(table: Path, tmp_path: Path) -> None:
    folder = run(table, tmp_path)
    expected = fitted_model(MODELS["lr"], SETTINGS, read_subset(table, TRAIN))
    np.testing.assert_array_equal(joblib.load(folder / "model.joblib").predict(PROBE), expected.predict(PROBE))


def test_the_record_holds_what_a_refit_needs_and_what_the_fit_took(table: Path, tmp_path: Path) -> None:
    base = {"origin": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0]}
    settings = FitSettings({"degree": 2}, True, seed=0, threads=1, target_space="curvature", base=base)
    record = read_json(run(table, tmp_path, settings=settings) / "fit.json")
    assert recorded_settings(record, seed=0, threads=1) == settings
    assert record["n_train"] == 40
    assert record["solvers_at_iteration_bound"] == 0
    assert record["fit_seconds"] > 0
    assert record["fit_cpu_seconds"] > 0
    assert record["predict_us_per_row"] > 0
    bounded = replace(SETTINGS, params={"C": 100.0, "epsilon": 1e-3, "max_iter": 2})
    assert read_json(run(table, tmp_path, "svr", bounded) / "fit.json")["solvers_at_iteration_bound"] == 3


def test_settings_that_two_studies_found_are_fitted_once(
    table: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitted: list[Any] = []

    def counted(estimator: Any, *given: Any) -> int:
        fitted.append(estimator)
        return fit_quietly(estimator, *given)

    monkeypatch.setattr("softkin.training.fit.fit_quietly", counted)
    found = [FitSettings({"alpha": alpha}, True, seed=0, threads=1) for alpha in (1e-3, 0.5, 1e-3)]
    files = [FitFiles(tmp_path / f"{i}.joblib", tmp_path / f"{i}.json", tmp_path / f"{i}.parquet") for i in range(3)]
    fit_each(table, spec=MODELS["lasso"], fits=list(zip(found, files, strict=True)))
    assert len(fitted) == 2
    for suffix in (".joblib", ".json", ".parquet"):
        first, other, again = ((tmp_path / f"{i}{suffix}").read_bytes() for i in range(3))
        assert first == again != other


def test_other_subsets_cannot_leak_into_a_fit(table: Path, tmp_path: Path) -> None:
    """With every row that is not in `train` replaced by garbage, the fitted model is the same to the bit."""
    subsets = {subset: read_subset(table, subset) for subset in SUBSETS}
    garbage = {s: Samples(1e6 + rows.commands, -1e6 * rows.positions) for s, rows in subsets.items() if s != TRAIN}
    write_table(to_table(subsets | garbage), tmp_path / "garbage.parquet")
    outputs = []
    for place, path in enumerate((table, tmp_path / "garbage.parquet")):
        folder = run(path, tmp_path / str(place), "gb")
        outputs.append(joblib.load(folder / "model.joblib").predict(PROBE))
    np.testing.assert_array_equal(*outputs)


def test_a_bound_on_the_rows_is_kept_and_recorded(
    table: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    folder = run(table, tmp_path, max_rows=15)
    assert read_json(folder / "fit.json")["n_train"] == 15
    assert "fitted on 15 of 40 rows: max_fit_rows" in caplog.text
    whole = fitted_model(MODELS["lr"], SETTINGS, read_subset(table, TRAIN))
    assert not np.allclose(joblib.load(folder / "model.joblib").predict(PROBE), whole.predict(PROBE))
