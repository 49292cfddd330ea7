from __future__ import annotations

import io
from typing import Any

import joblib
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.base import clone
from sklearn.ensemble import HistGradientBoostingRegressor

from softkin.core.samples import Array
from softkin.models.estimators.boosted_trees import QuantileLoss
from softkin.models.estimators.quick_histograms import QuickHistograms

SETTINGS: dict[str, Any] = {"early_stopping": False, "max_leaf_nodes": None, "max_iter": 8, "random_state": 3}


def rows(n_rows: int, n_commands: int, seed: int = 0) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    X = rng.uniform(-1, 1, (n_rows, n_commands))
    return X, np.sin(3 * X[:, 0]) + 0.1 * rng.standard_normal(n_rows)


def both(X: Array, y: Array, **settings: Any) -> tuple[HistGradientBoostingRegressor, QuickHistograms]:
    """scikit-learn's fit, and ours."""
    of_scikit_learn, ours = (kind(**SETTINGS | settings) for kind in (HistGradientBoostingRegressor, QuickHistograms))
    return of_scikit_learn.fit(X, y), ours.fit(X, y)


def assert_equal(expected: HistGradientBoostingRegressor, ours: QuickHistograms, X: Array) -> None:
    """The same trees, number by number, and the same predictions."""
    assert ours.n_iter_ == expected.n_iter_
    for (wanted,), (got,) in zip(expected._predictors, ours._predictors, strict=True):
        np.testing.assert_array_equal(got.nodes, wanted.nodes)
    np.testing.assert_array_equal(ours.predict(X), expected.predict(X))


@given(
    sizes=st.tuples(st.integers(2, 300), st.integers(1, 4)),
    max_depth=st.one_of(st.none(), st.integers(1, 6)),
    max_features=st.sampled_from([0.3, 0.5, 0.7, 1.0]),
    min_samples_leaf=st.integers(1, 20),
    loss=st.sampled_from(["squared_error", QuantileLoss(quantile=0.05), QuantileLoss(quantile=0.9)]),
    digits=st.sampled_from([1, 16]),
    seed=st.integers(0, 100),
)
def test_trees_are_scikit_learns_to_the_bit(
    sizes: tuple[int, int],
    max_depth: int | None,
    max_features: float,
    min_samples_leaf: int,
    loss: Any,
    digits: int,
    seed: int,
) -> None:
    X, y = (part.round(digits) for part in rows(*sizes, seed))  # rounded, rows and gains are alike
    settings = {"max_depth": max_depth, "max_features": max_features, "min_samples_leaf": min_samples_leaf}
    assert_equal(*both(X, y, loss=loss, learning_rate=0.3, random_state=seed, **settings), X)


def test_more_rows_than_bins_and_a_command_that_is_constant() -> None:
    X, y = rows(2000, 3)
    X[:, 1] = 5.0
    assert_equal(*both(X, y, max_depth=4, max_features=0.5, l2_regularization=0.7), X)


def test_targets_that_are_all_the_same_give_a_tree_of_one_leaf() -> None:
    X, _ = rows(30, 2)
    assert_equal(*both(X, np.full(30, 2.0)), X)


@pytest.mark.parametrize(
    "settings",
    [
        {"max_leaf_nodes": 4},
        {"early_stopping": True, "n_iter_no_change": 2},
        {"loss": "absolute_error"},
        {"loss": "gamma"},
        {"monotonic_cst": [1, 0]},
        {"interaction_cst": "no_interactions"},
        {"categorical_features": [1]},
    ],
    ids=lambda settings: next(iter(settings)),
)
def test_what_the_grower_does_not_know_is_left_to_scikit_learn(settings: dict[str, Any]) -> None:
    X, y = rows(200, 2)
    X[:, 1] = (X[:, 1] > 0).astype(float)
    assert_equal(*both(X, y - y.min() + 1.0, **settings), X)


def test_weights_and_missing_values_are_left_to_scikit_learn() -> None:
    X, y = rows(200, 2)
    X[::7, 0] = np.nan
    expected, ours = both(X, y)
    assert_equal(expected, ours, X)
    weights = np.linspace(0.1, 1.0, len(y))
    assert_equal(expected.fit(X, y, weights), ours.fit(X, y, weights), X)


def test_a_setting_that_is_none_is_refused() -> None:
    X, y = rows(20, 2)
    with pytest.raises(ValueError, match="max_iter"):
        QuickHistograms(**SETTINGS | {"max_iter": -1}).fit(X, y)


def test_it_is_cloned_fitted_anew_and_stored() -> None:
    X, y = rows(100, 2)
    fitted, file = clone(QuickHistograms(**SETTINGS)).fit(X, y), io.BytesIO()
    before = fitted.predict(X)
    np.testing.assert_array_equal(fitted.fit(X, y).predict(X), before)
    joblib.dump(fitted, file)
    file.seek(0)
    np.testing.assert_array_equal(joblib.load(file).predict(X), before)
