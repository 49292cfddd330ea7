"""A trend, and a regressor on its residuals."""

from __future__ import annotations

import numpy as np
import pytest
from sklearn.ensemble import GradientBoostingRegressor, RandomForestRegressor
from sklearn.linear_model import LinearRegression
from sklearn.multioutput import MultiOutputRegressor

from softkin.core.errors import ConfigError
from softkin.core.samples import Array, Samples
from softkin.models.estimators.detrended import Detrended, detrended, spread_around
from softkin.models.quantile import QUANTILE_MODELS
from tests.conftest import bending_arm

RNG = np.random.default_rng(0)
COMMANDS = RNG.uniform(-1, 1, (200, 2))
FAR = 5 * COMMANDS[:20]


def forest(params: dict[str, int]) -> RandomForestRegressor:
    return RandomForestRegressor(random_state=0, **params)


@pytest.mark.parametrize(("trend", "power"), [("linear", 1), ("quadratic", 2)])
def test_a_polynomial_is_continued_exactly(trend: str, power: int) -> None:
    targets = np.column_stack([COMMANDS[:, 0] ** power, 3 - (COMMANDS @ [1.0, 2.0]) ** power])
    fitted = detrended(forest, {"n_estimators": 5, "trend": trend}).fit(COMMANDS, targets)
    expected = np.column_stack([FAR[:, 0] ** power, 3 - (FAR @ [1.0, 2.0]) ** power])
    np.testing.assert_allclose(fitted.predict(FAR), expected, atol=1e-9)


def test_without_a_trend_it_is_the_regressor_itself() -> None:
    for params in ({"n_estimators": 5}, {"n_estimators": 5, "trend": "none"}):
        assert detrended(forest, params).get_params() == forest({"n_estimators": 5}).get_params()


def test_an_unknown_trend_is_an_error_that_names_the_known_ones() -> None:
    with pytest.raises(ConfigError, match="trend: 'cubic' is no trend") as caught:
        detrended(forest, {"trend": "cubic"})
    assert caught.value.fix == "set one of none, linear, quadratic"


def test_scaling_of_targets_changes_nothing() -> None:
    """The regressor sees standardised residuals: one and the same problem in any unit."""
    targets = np.sin(3 * COMMANDS)
    model = Detrended(MultiOutputRegressor(GradientBoostingRegressor(random_state=0)), 1)
    small, large = (model.fit(COMMANDS, factor * targets).predict(FAR) for factor in (1.0, 1024.0))
    np.testing.assert_allclose(large, 1024.0 * small, rtol=1e-9)


def test_the_spread_is_that_of_the_residuals_in_the_unit_of_the_targets() -> None:
    targets = np.sin(3 * COMMANDS)
    fitted = Detrended(forest({"n_estimators": 20}), 1).fit(COMMANDS, targets)

    def over_trees(regressor: RandomForestRegressor, train: Samples, commands: Array) -> Array:
        np.testing.assert_allclose(train.positions.std(axis=0), 1.0)
        return np.std([tree.predict(commands) for tree in regressor.estimators_], axis=0)

    residuals = targets - LinearRegression().fit(COMMANDS, targets).predict(COMMANDS)
    unit = residuals.std(axis=0)
    plain = forest({"n_estimators": 20}).fit(COMMANDS, residuals / unit)
    spread = spread_around(over_trees, fitted, Samples(COMMANDS, targets), FAR)
    np.testing.assert_allclose(spread, unit * np.std([t.predict(FAR) for t in plain.estimators_], axis=0), rtol=1e-6)


@pytest.mark.parametrize("name", QUANTILE_MODELS)
def test_quantiles_of_one_coordinate_move_with_the_trend(name: str) -> None:
    """Around y = 10 x + noise the quantiles stay as far apart wherever they are, and rise with x."""
    arm = bending_arm(400)
    targets = 10 * arm.commands[:, 0] + 0.1 * RNG.standard_normal(400)
    params = {"n_estimators": 30, "trend": "linear"}
    model = QUANTILE_MODELS[name].build(params, [0.05, 0.95], 0, 1).fit(arm.commands, targets)
    for place in (-3.0, 0.0, 3.0):
        low, high = model.predict(np.array([[place, 0.0]]))[0]
        assert 10 * place - 0.5 < low < high < 10 * place + 0.5
