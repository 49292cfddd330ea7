from __future__ import annotations

import io
from typing import Any

import joblib
import numpy as np
import pytest
from sklearn.base import clone
from xgboost import XGBRegressor

from softkin.models.estimators.quick_xgboost import QuickXGBoost

RNG = np.random.default_rng(0)
COMMANDS = RNG.uniform(-1, 1, (150, 2))
TARGETS = np.column_stack([np.sin(3 * COMMANDS[:, 0]), COMMANDS.sum(axis=1)]) + 0.1 * RNG.standard_normal((150, 2))
SETTINGS: dict[str, Any] = {"n_estimators": 12, "subsample": 0.7, "random_state": 3, "n_jobs": 1}
LEVELS: dict[str, Any] = {"objective": "reg:quantileerror", "quantile_alpha": [0.05, 0.95]}


@pytest.mark.parametrize(("settings", "columns"), [({}, slice(None)), ({}, 0), (LEVELS, 1)])
def test_trees_are_xgboosts_to_the_bit(settings: dict[str, Any], columns: Any) -> None:
    y = TARGETS[:, columns]
    expected, ours = (kind(**SETTINGS, **settings).fit(COMMANDS, y) for kind in (XGBRegressor, QuickXGBoost))
    np.testing.assert_array_equal(ours.predict(COMMANDS), expected.predict(COMMANDS))
    texts = [bytes(each.get_booster().save_raw("json")) for each in (ours, expected)]
    assert texts[0] == texts[1]


def test_it_is_cloned_and_stored() -> None:
    model = QuickXGBoost(**SETTINGS)
    assert clone(model).get_params() == model.get_params() == XGBRegressor(**SETTINGS).get_params()
    fitted, file = clone(model).fit(COMMANDS, TARGETS), io.BytesIO()
    joblib.dump(fitted, file)
    file.seek(0)
    stored = joblib.load(file)
    assert stored.n_features_in_ == 2
    np.testing.assert_array_equal(stored.predict(COMMANDS), fitted.predict(COMMANDS))
