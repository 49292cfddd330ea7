from __future__ import annotations

import numpy as np
from optuna.trial import FixedTrial

from softkin.core.samples import Samples
from softkin.models.gaussian_process import SPEC
from tests.conftest import bending_arm

PARAMS = {"kernel": "rbf", "trend": "none", "learning_rows": 60, "max_iter": 20}


def standardised(n_rows: int, seed: int = 0) -> Samples:
    rows = bending_arm(n_rows, seed=seed)
    return Samples(rows.commands, (rows.positions - rows.positions.mean(axis=0)) / rows.positions.std(axis=0))


def test_the_spread_is_that_of_the_posterior_and_grows_away_from_the_rows() -> None:
    assert SPEC.spread is not None
    assert SPEC.is_predictive
    train = standardised(80)
    regressor = SPEC.build(PARAMS, 0, 1).fit(train.commands, train.positions)
    spread = SPEC.spread(regressor, train, train.commands)
    np.testing.assert_array_equal(spread, regressor.predict_std(train.commands))
    assert spread.shape == (80, 3)
    far = SPEC.spread(regressor, train, 10 * train.commands)
    assert (far.mean(axis=0) > 3 * spread.mean(axis=0)).all()


def test_without_a_trend_it_returns_to_the_mean_and_a_linear_kernel_goes_on() -> None:
    rng = np.random.default_rng(0)
    commands = rng.uniform(-1, 1, (60, 1))
    targets = 1.7 * commands + 0.01 * rng.standard_normal((60, 1))
    far = np.array([[50.0]])
    back = SPEC.build(PARAMS | {"initial_length_scale": 0.3}, 0, 1).fit(commands, targets).predict(far)
    assert np.abs(back).max() < 1.0
    on = SPEC.build(PARAMS | {"trend": "linear"}, 0, 1).fit(commands, targets).predict(far)
    assert on.item() > 40.0


def test_the_seed_draws_the_rows_of_the_likelihood() -> None:
    train = standardised(80)
    one, same, other = (
        SPEC.build(PARAMS | {"learning_rows": 20}, seed, 1).fit(train.commands, train.positions) for seed in (0, 0, 1)
    )
    np.testing.assert_array_equal(one.predict(train.commands), same.predict(train.commands))
    assert not np.array_equal(one.posterior_.kernel_.theta, other.posterior_.kernel_.theta)


def test_every_trial_bounds_the_cost_of_the_likelihood() -> None:
    for first in SPEC.first_trials:
        params = SPEC.search_space(FixedTrial(dict(first)))
        assert (params["learning_rows"], params["max_iter"]) == (200, 40)
