from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from sklearn.ensemble import GradientBoostingRegressor
from sklearn.utils.stats import _weighted_percentile

from softkin.core.samples import Array
from softkin.models.estimators.quick_boosting import QuickBoosting, order_statistic

SETTINGS: dict[str, Any] = {"n_estimators": 8, "random_state": 3}
QUANTILES = [0.025, 0.05, 0.1, 0.5, 0.9, 0.95, 0.975]


def rows(n_rows: int, n_commands: int, seed: int = 0) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    X = rng.uniform(-1, 1, (n_rows, n_commands))
    return X, np.sin(3 * X[:, 0]) + 0.1 * rng.standard_normal(n_rows)


def assert_equal(X: Array, y: Array, **settings: Any) -> None:
    """scikit-learn's fit and ours have the same trees, number by number, losses and predictions."""
    expected, ours = (kind(**SETTINGS | settings).fit(X, y) for kind in (GradientBoostingRegressor, QuickBoosting))
    np.testing.assert_array_equal(ours.train_score_, expected.train_score_)
    np.testing.assert_array_equal(ours.predict(X), expected.predict(X))
    for got, wanted in zip(ours.estimators_.ravel(), expected.estimators_.ravel(), strict=True):
        states = [one.tree_.__getstate__() for one in (got, wanted)]
        for name in ("nodes", "values"):
            np.testing.assert_array_equal(*(state[name] for state in states))
        np.testing.assert_array_equal(got.predict(X), wanted.predict(X))


@given(
    sizes=st.tuples(st.integers(2, 200), st.integers(1, 4)),
    max_depth=st.one_of(st.none(), st.integers(1, 5)),
    quantile=st.one_of(st.none(), st.sampled_from(QUANTILES)),
    digits=st.sampled_from([1, 16]),
    seed=st.integers(0, 100),
)
def test_trees_are_scikit_learns_to_the_bit(
    sizes: tuple[int, int], max_depth: int | None, quantile: float | None, digits: int, seed: int
) -> None:
    X, y = (part.round(digits) for part in rows(*sizes, seed))  # rounded, rows and gains are alike
    loss = {} if quantile is None else {"loss": "quantile", "alpha": quantile}
    assert_equal(X, y, max_depth=max_depth, learning_rate=0.3, random_state=seed, **loss)


@pytest.mark.parametrize(
    "settings",
    [
        {"loss": "absolute_error"},
        {"loss": "huber"},
        {"subsample": 0.5},
        {"max_features": 1},
        {"max_leaf_nodes": 4},
        {"min_samples_leaf": 9},
        {"min_samples_split": 9},
        {"min_weight_fraction_leaf": 0.1},
        {"ccp_alpha": 0.01},
        {"n_iter_no_change": 2},
    ],
    ids=lambda settings: "-".join(settings),
)
def test_other_losses_and_trees_are_scikit_learns(settings: dict[str, Any]) -> None:
    assert_equal(*rows(200, 2), **settings)


def test_weighted_rows_are_left_to_scikit_learn() -> None:
    X, y = rows(100, 2)
    weights = np.linspace(0.1, 1.0, len(y))
    kinds = (kind(loss="quantile", **SETTINGS) for kind in (GradientBoostingRegressor, QuickBoosting))
    np.testing.assert_array_equal(*(each.fit(X, y, weights).predict(X) for each in kinds))


@given(arrays(np.float64, st.integers(1, 60), elements=st.floats(-1e6, 1e6)), st.sampled_from(QUANTILES))
def test_the_quantile_of_a_leaf_is_that_of_equal_weights(values: Array, quantile: float) -> None:
    assert order_statistic(values, quantile) == _weighted_percentile(values, np.ones(len(values)), 100 * quantile)
