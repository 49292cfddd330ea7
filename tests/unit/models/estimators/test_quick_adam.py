from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.exceptions import ConvergenceWarning
from sklearn.neural_network import MLPRegressor

from softkin.core.samples import Array
from softkin.models.estimators.fused_network import ACTIVATIONS, FusedNetwork

pytestmark = pytest.mark.filterwarnings("ignore::sklearn.exceptions.ConvergenceWarning")


def rows(n_rows: int, n_commands: int, n_targets: int, seed: int = 0) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    X, y = rng.standard_normal((n_rows, n_commands)), rng.standard_normal((n_rows, n_targets))
    return X, y[:, 0] if n_targets == 1 else y


def assert_equal(X: Array, y: Array, *weights: Array, **settings: Any) -> None:
    """scikit-learn's fit and ours have the same losses, passes and parameters, to the bit."""
    expected, ours = (kind(**settings).fit(X, y, *weights) for kind in (MLPRegressor, FusedNetwork))
    assert ours.loss_curve_ == expected.loss_curve_
    assert (ours.n_iter_, ours.t_, ours.loss_) == (expected.n_iter_, expected.t_, expected.loss_)
    for got, wanted in zip((*ours.coefs_, *ours.intercepts_), (*expected.coefs_, *expected.intercepts_), strict=True):
        np.testing.assert_array_equal(got, wanted)
        assert got.flags.c_contiguous
    np.testing.assert_array_equal(ours.predict(X), expected.predict(X))


@given(
    activation=st.sampled_from(sorted(ACTIVATIONS)),
    widths=st.lists(st.integers(1, 12), min_size=1, max_size=3),
    alpha=st.one_of(st.just(0.0), st.floats(1e-6, 1.0)),
    sizes=st.tuples(st.integers(1, 450), st.integers(1, 4), st.integers(1, 5)),
    seed=st.integers(0, 1000),
)
def test_a_fit_is_scikit_learns_to_the_bit(
    activation: str, widths: list[int], alpha: float, sizes: tuple[int, int, int], seed: int
) -> None:
    settings: dict[str, Any] = {
        "hidden_layer_sizes": widths,
        "activation": activation,
        "alpha": alpha,
        "learning_rate_init": 0.02,
    }
    assert_equal(*rows(*sizes, seed), **settings, max_iter=6, random_state=seed)


def test_it_stops_where_scikit_learn_stops_and_says_when_it_was_stopped() -> None:
    X, y = rows(60, 2, 2)
    assert_equal(X, y, hidden_layer_sizes=(4,), tol=0.1, n_iter_no_change=3, max_iter=200, random_state=0)
    with warnings.catch_warnings():
        warnings.simplefilter("error", ConvergenceWarning)
        FusedNetwork(hidden_layer_sizes=(4,), tol=0.1, n_iter_no_change=3, max_iter=200, random_state=0).fit(X, y)
    with pytest.warns(ConvergenceWarning, match="Adam stopped after 2 passes"):
        FusedNetwork(hidden_layer_sizes=(4,), max_iter=2, random_state=0).fit(X, y)


@pytest.mark.parametrize(
    "settings",
    [{"solver": "sgd"}, {"early_stopping": True}, {"shuffle": False}, {"batch_size": 30}, {"loss": "poisson"}],
    ids=lambda settings: next(iter(settings)),
)
def test_other_ways_to_search_are_scikit_learns(settings: dict[str, Any]) -> None:
    X, y = rows(100, 2, 2)
    assert_equal(X, np.square(y), **settings, hidden_layer_sizes=(4,), max_iter=5, random_state=0)


def test_weighted_rows_and_arrays_stored_otherwise_are_fitted_as_by_scikit_learn() -> None:
    X, y = rows(100, 2, 2)
    settings: dict[str, Any] = {"hidden_layer_sizes": (4,), "max_iter": 5, "random_state": 0}
    assert_equal(X, y, np.linspace(0.5, 2.0, len(X)), **settings)
    assert_equal(np.asfortranarray(X), np.asfortranarray(y), **settings)
    assert_equal(X.astype(np.float32), y.astype(np.float32), **settings)


def test_fits_go_on_where_they_were_as_scikit_learns_do() -> None:
    X, y = rows(100, 2, 2)
    settings: dict[str, Any] = {"hidden_layer_sizes": (4,), "max_iter": 3, "random_state": 0, "warm_start": True}
    expected, ours = (kind(**settings).fit(X, y).fit(X, y) for kind in (MLPRegressor, FusedNetwork))
    np.testing.assert_array_equal(ours.predict(X), expected.predict(X))
    expected, ours = (kind(random_state=0).partial_fit(X, y).partial_fit(X, y) for kind in (MLPRegressor, FusedNetwork))
    np.testing.assert_array_equal(ours.predict(X), expected.predict(X))
