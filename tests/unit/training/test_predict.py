from __future__ import annotations

from pathlib import Path

import joblib
import numpy as np
import pandas as pd
import pytest

from softkin.core.samples import SUBSETS, TRAIN, Params, coordinate_columns
from softkin.data.table import read_subset
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.training.predict import SPREAD, STANDARD_DEVIATION, predict, predicted_rows, rows_with_spread, spread_of

SMALL: dict[str, Params] = {
    "lr": {},
    "rf": {"n_estimators": 10},
    "gp": {"kernel": "rbf", "trend": "none", "learning_rows": 40, "max_iter": 5},
}
PREFIXES = {"lr": None, "rf": SPREAD, "gp": STANDARD_DEVIATION}


def run(table: Path, folder: Path, model: str) -> pd.DataFrame:
    settings = FitSettings(SMALL[model], skip_constant=True, seed=0, threads=1)
    estimator = fitted_model(MODELS[model], settings, read_subset(table, TRAIN))
    joblib.dump(estimator, folder / "model.joblib")
    predictions = folder / "predictions.parquet"
    assert predict(table, spec=MODELS[model], estimator=estimator, threads=1, predictions=predictions) > 0
    return pd.read_parquet(predictions)


def test_every_subset_is_predicted_row_by_row(table: Path, tmp_path: Path) -> None:
    predictions = run(table, tmp_path, "lr")
    assert predictions["subset"].tolist() == pd.read_parquet(table)["subset"].tolist()
    model = joblib.load(tmp_path / "model.joblib")
    for subset in SUBSETS:
        expected = model.predict(read_subset(table, subset).commands)
        predicted = predictions.loc[predictions["subset"] == subset].drop(columns="subset").to_numpy()
        np.testing.assert_array_equal(predicted, expected)


@pytest.mark.parametrize("model", SMALL)
def test_a_model_with_a_spread_has_columns_that_say_of_which_kind_it_is(
    table: Path, tmp_path: Path, model: str
) -> None:
    predictions = run(table, tmp_path, model)
    positions, prefix = coordinate_columns(1), PREFIXES[model]
    assert (prefix is None) == (MODELS[model].spread is None)
    spreads = [] if prefix is None else [prefix + name for name in positions]
    assert predictions.columns.tolist() == ["subset", *positions, *spreads]
    if spreads:
        estimator, train = joblib.load(tmp_path / "model.joblib"), read_subset(table, TRAIN)
        for subset in SUBSETS:
            commands = read_subset(table, subset).commands
            rows = predictions.loc[predictions["subset"] == subset, spreads].to_numpy()
            np.testing.assert_array_equal(rows, spread_of(MODELS[model], estimator, train, commands))
            assert (rows > 0).all()


@pytest.mark.parametrize("target_space", ["cartesian", "curvature"])
def test_the_spread_of_a_forest_is_that_of_its_trees_in_mm(table: Path, target_space: str) -> None:
    """To first order in arcs, exactly in positions."""
    train = read_subset(table, TRAIN)
    params = {"n_estimators": 30, "trend": "quadratic"}
    settings = FitSettings(params, skip_constant=True, seed=0, threads=1, target_space=target_space)
    estimator = fitted_model(MODELS["rf"], settings, train)
    commands = estimator.regressor_[0].transform(train.commands)
    detrended = estimator.regressor_[-1]
    trend = detrended.trend_.predict(commands)
    trees = [trend + tree.predict(commands) * detrended.scale_ for tree in detrended.regressor_.estimators_]
    positions = np.stack([estimator.transformer_.inverse_transform(tree) for tree in trees])
    spread = spread_of(MODELS["rf"], estimator, train, train.commands)
    tolerance = {"cartesian": 1e-6, "curvature": 0.3}[target_space]
    np.testing.assert_allclose(spread.mean(axis=0), positions.std(axis=0).mean(axis=0), rtol=tolerance)


def test_of_many_rows_of_train_some_have_a_spread_and_every_other_row_has(
    table: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    every = run(table, tmp_path, "gp").filter(like=STANDARD_DEVIATION).to_numpy()
    monkeypatch.setattr("softkin.training.predict.SPREAD_ROWS", 7)
    monkeypatch.setattr("softkin.training.predict.TIMED_ROWS", 3)
    predictions = run(table, tmp_path, "gp")
    some, is_train = predictions.filter(like=STANDARD_DEVIATION).to_numpy(), (predictions["subset"] == TRAIN).to_numpy()
    assert not np.isnan(predictions.filter(like="m1_").drop(columns=predictions.filter(like="std_")).to_numpy()).any()
    np.testing.assert_array_equal(some[~is_train], every[~is_train])
    kept = np.flatnonzero(~np.isnan(some[is_train]).any(axis=1))
    np.testing.assert_array_equal(kept, rows_with_spread(int(is_train.sum())))
    assert len(kept) == 7
    np.testing.assert_allclose(some[is_train][kept], every[is_train][kept], rtol=1e-9)


def test_predicted_rows_are_in_the_order_of_the_subsets_asked_for() -> None:
    stored = pd.DataFrame({"subset": ["test", "train", "test"], "m1_x": [1.0, 2.0, 3.0], "std_m1_x": [4.0, 5.0, 6.0]})
    assert predicted_rows(stored, ["train", "test"]).tolist() == [[2.0], [1.0], [3.0]]
    assert predicted_rows(stored, ["test"], "std_").tolist() == [[4.0], [6.0]]
