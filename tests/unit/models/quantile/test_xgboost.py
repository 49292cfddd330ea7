from __future__ import annotations

import numpy as np

from softkin.models.quantile.xgboost import SPEC

RNG = np.random.default_rng(0)
COMMANDS = RNG.uniform(-1, 1, (200, 2))
TARGETS = COMMANDS[:, 0] + 0.3 * RNG.standard_normal(200)


def test_all_quantiles_come_from_one_ensemble() -> None:
    fitted = SPEC.build({"n_estimators": 5}, [0.05, 0.5, 0.95], 0, 1).fit(COMMANDS, TARGETS)
    assert fitted.predict(COMMANDS).shape == (200, 3)
    assert fitted.get_params()["objective"] == "reg:quantileerror"
    assert len(fitted.get_booster().get_dump()) == 5 * 3  # a tree per quantile and round, in one booster


def test_quantiles_are_ascending_and_hold_about_their_share() -> None:
    params = {"n_estimators": 40, "max_depth": 2, "learning_rate": 0.1}
    predicted = SPEC.build(params, [0.1, 0.9], 0, 1).fit(COMMANDS, TARGETS).predict(COMMANDS)
    assert (predicted[:, 1] > predicted[:, 0]).mean() > 0.99
    shares = (TARGETS[:, None] <= predicted).mean(axis=0)
    np.testing.assert_allclose(shares, [0.1, 0.9], atol=0.08)


def test_around_a_trend_all_quantiles_move_with_it() -> None:
    fitted = SPEC.build({"n_estimators": 20, "trend": "linear"}, [0.1, 0.9], 0, 1).fit(COMMANDS, TARGETS)
    low, high = fitted.predict(np.array([[-5.0, 0.0], [5.0, 0.0]]))
    assert (low < -3).all()
    assert (high > 3).all()


def test_it_takes_the_threads_it_is_allowed() -> None:
    assert SPEC.build({}, [0.5], 0, 2).n_jobs == 2
