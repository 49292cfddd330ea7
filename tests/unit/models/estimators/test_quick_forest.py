from __future__ import annotations

import io
from typing import Any

import joblib
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.base import clone
from sklearn.ensemble import RandomForestRegressor

from softkin.core.samples import Array
from softkin.models.estimators.quick_forest import QuickForest

SETTINGS: dict[str, Any] = {"n_estimators": 6, "random_state": 3, "n_jobs": 1}


def rows(n_rows: int, n_commands: int, n_targets: int, seed: int = 0) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    X, y = rng.uniform(-1, 1, (n_rows, n_commands)), rng.standard_normal((n_rows, n_targets))
    return X, y[:, 0] if n_targets == 1 else y


def assert_equal(X: Array, y: Array, *weights: Array, **settings: Any) -> None:
    """scikit-learn's fit and ours have the same trees, number by number, settings and predictions."""
    expected, ours = (kind(**SETTINGS | settings).fit(X, y, *weights) for kind in (RandomForestRegressor, QuickForest))
    np.testing.assert_array_equal(ours.predict(X), expected.predict(X))
    for got, wanted in zip(ours.estimators_, expected.estimators_, strict=True):
        states = [one.tree_.__getstate__() for one in (got, wanted)]
        for name in ("nodes", "values"):
            np.testing.assert_array_equal(*(state[name] for state in states))
        assert got.get_params() == wanted.get_params()
        np.testing.assert_array_equal(got.predict(X), wanted.predict(X))


@given(
    sizes=st.tuples(st.integers(1, 200), st.integers(1, 4), st.integers(1, 4)),
    max_depth=st.one_of(st.none(), st.integers(1, 9)),
    max_features=st.one_of(st.floats(0.1, 1.0), st.just(1)),
    min_samples_leaf=st.integers(1, 9),
    bootstrap=st.booleans(),
    seed=st.integers(0, 100),
)
def test_trees_are_scikit_learns_to_the_bit(
    sizes: tuple[int, int, int],
    max_depth: int | None,
    max_features: float,
    min_samples_leaf: int,
    bootstrap: bool,
    seed: int,
) -> None:
    settings: dict[str, Any] = {
        "max_features": max_features,
        "min_samples_leaf": min_samples_leaf,
        "bootstrap": bootstrap,
    }
    assert_equal(*rows(*sizes, seed), max_depth=max_depth, random_state=seed, **settings)


@pytest.mark.parametrize(
    "settings",
    [
        {"criterion": "absolute_error"},
        {"max_leaf_nodes": 4},
        {"min_samples_split": 9},
        {"min_samples_leaf": 0.1},
        {"min_weight_fraction_leaf": 0.1},
        {"min_impurity_decrease": 0.1},
        {"max_features": "sqrt"},
        {"max_samples": 20},
        {"monotonic_cst": [1, 0]},
        {"ccp_alpha": 0.1},
    ],
    ids=lambda settings: next(iter(settings)),
)
def test_other_settings_are_scikit_learns(settings: dict[str, Any]) -> None:
    assert_equal(*rows(60, 2, 1), **settings)


def test_scores_of_rows_out_of_bag_weights_and_missing_values_are_scikit_learns() -> None:
    X, y = rows(80, 2, 2)
    assert_equal(X, y, np.linspace(0.1, 1.0, len(X)))
    fits = [
        kind(n_estimators=30, oob_score=True, random_state=0).fit(X, y) for kind in (RandomForestRegressor, QuickForest)
    ]
    assert fits[0].oob_score_ == fits[1].oob_score_
    X[::7, 0] = np.nan
    expected, ours = (kind(**SETTINGS).fit(X, y) for kind in (RandomForestRegressor, QuickForest))
    np.testing.assert_array_equal(ours.predict(X[1:7]), expected.predict(X[1:7]))


def test_a_setting_that_is_none_is_refused() -> None:
    with pytest.raises(ValueError, match="n_estimators"):
        QuickForest(n_estimators=-1).fit(*rows(20, 2, 2))


def test_it_is_cloned_and_stored() -> None:
    X, y = rows(60, 2, 2)
    fitted, file = clone(QuickForest(**SETTINGS)).fit(X, y), io.BytesIO()
    joblib.dump(fitted, file)
    file.seek(0)
    np.testing.assert_array_equal(joblib.load(file).predict(X), fitted.predict(X))
