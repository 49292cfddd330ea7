from __future__ import annotations

import numpy as np
from sklearn.base import clone
from sklearn.ensemble import GradientBoostingRegressor

from softkin.models.estimators.boosted_quantiles import BoostedQuantiles

RNG = np.random.default_rng(0)
COMMANDS = RNG.uniform(-1, 1, (300, 2))
NOISE = RNG.standard_normal(300)
QUANTILES = (0.05, 0.5, 0.95)


def test_each_quantile_is_an_ensemble_of_its_own() -> None:
    params = {"n_estimators": 10, "max_depth": 2}
    predicted = BoostedQuantiles(QUANTILES, params, random_state=4).fit(COMMANDS, NOISE).predict(COMMANDS)
    assert predicted.shape == (300, 3)
    for column, quantile in zip(predicted.T, QUANTILES, strict=True):
        alone = GradientBoostingRegressor(loss="quantile", alpha=quantile, **params, random_state=4)
        np.testing.assert_array_equal(column, alone.fit(COMMANDS, NOISE).predict(COMMANDS))


def test_each_column_holds_its_share_of_the_noise() -> None:
    predicted = BoostedQuantiles(QUANTILES, {"n_estimators": 20, "max_depth": 1}).fit(COMMANDS, NOISE).predict(COMMANDS)
    shares = (NOISE[:, None] <= predicted).mean(axis=0)
    np.testing.assert_allclose(shares, QUANTILES, atol=0.05)


def test_it_is_a_scikit_learn_estimator() -> None:
    model = BoostedQuantiles(QUANTILES, {"n_estimators": 3}, random_state=1)
    assert clone(model).get_params() == model.get_params()
