from __future__ import annotations

from pathlib import Path

import joblib
import numpy as np
import pandas as pd
import pytest

from softkin.core.files import read_json
from softkin.core.samples import SUBSETS, TRAIN, Samples
from softkin.data.table import read_subset, to_table, write_table
from softkin.models import MODELS
from softkin.training.fit import fit, fit_quietly, kinematic_model, some_rows
from softkin.training.predict import predict
from tests.conftest import bending_arm, four_subsets


def run(table: Path, folder: Path, model: str = "lr") -> tuple[pd.DataFrame, dict[str, float]]:
    spec = MODELS[model]
    files = {"model": folder / "model.joblib", "record": folder / "fit.json"}
    params = {**spec.paper_params}
    fit(table, spec=spec, params=params, skip_constant=False, seed=0, threads=1, **files)
    predictions = folder / "predictions.parquet"
    predict(
        table,
        spec=spec,
        model=files["model"],
        threads=1,
        predictions=predictions,
        record=folder / "predict.json",
    )
    return pd.read_parquet(predictions), read_json(folder / "fit.json") | read_json(folder / "predict.json")


def test_every_subset_is_predicted_row_by_row(table: Path, tmp_path: Path) -> None:
    predictions, record = run(table, tmp_path)
    assert predictions["subset"].tolist() == pd.read_parquet(table)["subset"].tolist()
    assert record["n_train"] == 40
    assert record["fit_seconds"] > 0
    assert record["predict_us_per_row"] > 0
    model = joblib.load(tmp_path / "model.joblib")
    for subset in SUBSETS:
        expected = model.predict(read_subset(table, subset).commands)
        found = predictions.loc[predictions["subset"] == subset].drop(columns="subset").to_numpy()
        np.testing.assert_array_equal(found, expected)


def test_other_subsets_cannot_leak_into_a_fit(table: Path, tmp_path: Path) -> None:
    """Replace every row outside `train` by garbage: the fitted model stays the same to the bit."""
    subsets = {subset: read_subset(table, subset) for subset in SUBSETS}
    garbage = {s: Samples(1e6 + rows.commands, -1e6 * rows.positions) for s, rows in subsets.items() if s != TRAIN}
    write_table(to_table(subsets | garbage), tmp_path / "garbage.parquet")
    probe = bending_arm(9, seed=7).commands
    outputs = []
    for place, path in enumerate((table, tmp_path / "garbage.parquet")):
        (tmp_path / str(place)).mkdir()
        run(path, tmp_path / str(place), "gb")
        outputs.append(joblib.load(tmp_path / str(place) / "model.joblib").predict(probe))
    np.testing.assert_array_equal(*outputs)


def test_the_unit_of_the_commands_does_not_matter(samples: Samples) -> None:
    """Commands and positions are standardised inside, on what the model is fitted on."""
    for model in ("lasso", "svr", "mlp"):
        predicted = []
        for factor in (1.0, 1024.0):
            spec = MODELS[model]
            estimator = kinematic_model(spec, {**spec.paper_params}, skip_constant=False, seed=0, threads=1)
            fit_quietly(estimator, Samples(samples.commands * factor, samples.positions), 1)
            predicted.append(estimator.predict(samples.commands * factor))
        np.testing.assert_allclose(*predicted, rtol=1e-6)


def test_solvers_stopped_at_their_bound_are_counted(samples: Samples) -> None:
    spec = MODELS["svr"]
    bounded = {"kernel": "rbf", "C": 100.0, "epsilon": 1e-3, "gamma": 1.0, "max_iter": 2}
    estimator = kinematic_model(spec, bounded, skip_constant=True, seed=0, threads=1)
    assert fit_quietly(estimator, samples, 1) == 3
    free = kinematic_model(spec, {}, skip_constant=True, seed=0, threads=1)
    assert fit_quietly(free, samples, 1) == 0


def test_a_coordinate_that_never_varies_is_predicted_exactly() -> None:
    rows = four_subsets(dict.fromkeys(SUBSETS, 40), n_commands=3, n_markers=2)[TRAIN]
    estimator = kinematic_model(MODELS["mlp"], {**MODELS["mlp"].paper_params}, skip_constant=True, seed=0, threads=1)
    fit_quietly(estimator, rows, 1)
    np.testing.assert_array_equal(estimator.predict(rows.commands)[:, :3], rows.positions[:, :3])


def test_a_model_that_cannot_take_all_rows_gets_some_and_the_log_says_so(caplog: pytest.LogCaptureFixture) -> None:
    rows = bending_arm(50)
    kept = some_rows(rows, 20, seed=0)
    assert len(kept) == 20
    places = [int(np.flatnonzero((rows.commands == row).all(axis=1))[0]) for row in kept.commands]
    assert places == sorted(set(places))
    np.testing.assert_array_equal(rows.positions[places], kept.positions)
    assert "fitted on 20 of 50 rows: max_fit_rows" in caplog.text
    caplog.clear()
    assert some_rows(rows, 50, seed=0) is rows is some_rows(rows, None, seed=0)
    assert not caplog.text
