from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.base import clone
from sklearn.exceptions import ConvergenceWarning
from sklearn.neural_network import MLPRegressor

from softkin.core.samples import Array
from softkin.models.estimators.fused_network import ACTIVATIONS, FusedLoss, FusedNetwork

pytestmark = pytest.mark.filterwarnings("ignore::sklearn.exceptions.ConvergenceWarning")


def rows(n_rows: int, n_commands: int, n_targets: int, seed: int = 0) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    return rng.standard_normal((n_rows, n_commands)), rng.standard_normal((n_rows, n_targets))


def loss_of_scikit_learn(network: MLPRegressor, X: Array, y: Array, row_weights: Array) -> tuple[float, list[Array]]:
    """Loss and gradient at the weights of `network`, a matrix per layer with the biases as last column."""
    n = network.n_layers_ - 1
    lists: list[list[Any]] = [[X, *[None] * n], [None] * n, [None] * n, [None] * n]
    loss, weights, biases = network._backprop(X, y, row_weights, *lists)
    return float(loss), [np.column_stack([w.T, b]) for w, b in zip(weights, biases, strict=True)]


@given(
    activation=st.sampled_from(sorted(ACTIVATIONS)),
    widths=st.lists(st.integers(1, 12), min_size=1, max_size=3),
    alpha=st.one_of(st.just(0.0), st.floats(1e-6, 1.0)),
    sizes=st.tuples(st.integers(1, 30), st.integers(1, 4), st.integers(1, 5)),
    scale=st.sampled_from([1e-3, 1.0, 30.0]),
    seed=st.integers(0, 1000),
)
def test_loss_and_gradient_are_scikit_learns(
    activation: str, widths: list[int], alpha: float, sizes: tuple[int, int, int], scale: float, seed: int
) -> None:
    X, y = rows(*sizes, seed)
    row_weights = np.random.default_rng(seed).uniform(0.5, 2.0, len(X))
    network = MLPRegressor(
        hidden_layer_sizes=widths, activation=activation, alpha=alpha, solver="lbfgs", max_iter=1, random_state=seed
    ).fit(X, np.squeeze(y, axis=1) if y.shape[1] == 1 else y)
    network.coefs_ = [scale * weights for weights in network.coefs_]
    expected, gradients = loss_of_scikit_learn(network, X, y, row_weights)
    fused = FusedLoss(X, y, row_weights, widths=widths, activation=activation, alpha=alpha)
    layers = [np.column_stack([w.T, b]) for w, b in zip(network.coefs_, network.intercepts_, strict=True)]
    packed = np.concatenate([layer.ravel() for layer in layers])
    for _ in range(2):  # arrays that are used again hold nothing of the call before
        with np.errstate(over="ignore"):
            loss, gradient = fused(packed)
        assert loss == pytest.approx(expected, rel=1e-10)
        size = max(np.abs(each).max() for each in gradients)
        for got, wanted in zip(fused.layers(gradient), gradients, strict=True):
            np.testing.assert_allclose(got, wanted, rtol=1e-8, atol=1e-10 * size)


@pytest.mark.parametrize("activation", sorted(ACTIVATIONS))
@pytest.mark.parametrize("n_targets", [1, 3])
def test_a_fit_goes_where_scikit_learns_goes(activation: str, n_targets: int) -> None:
    X, y = rows(50, 2, n_targets)
    expected = MLPRegressor(
        hidden_layer_sizes=(6, 4), activation=activation, solver="lbfgs", max_iter=15, random_state=3
    )
    fused = FusedNetwork(**expected.get_params())
    targets = y[:, 0] if n_targets == 1 else y
    expected.fit(X, targets)
    fused.fit(X, targets)
    assert fused.n_iter_ == expected.n_iter_
    assert fused.loss_ == pytest.approx(expected.loss_, rel=1e-8)
    np.testing.assert_allclose(fused.predict(X), expected.predict(X), atol=1e-6)
    for got, wanted in zip((*fused.coefs_, *fused.intercepts_), (*expected.coefs_, *expected.intercepts_), strict=True):
        assert got.shape == wanted.shape
        assert got.flags["C_CONTIGUOUS"]


def test_a_row_that_counts_twice_is_a_row_that_stands_twice() -> None:
    X, y = rows(20, 2, 2)
    network = FusedNetwork(hidden_layer_sizes=(4,), activation="tanh", solver="lbfgs", max_iter=10, random_state=0)
    twice = clone(network).fit(np.concatenate([X, X[:5]]), np.concatenate([y, y[:5]]))
    counted = clone(network).fit(X, y, sample_weight=np.where(np.arange(20) < 5, 2.0, 1.0))
    np.testing.assert_allclose(counted.predict(X), twice.predict(X), atol=1e-8)


def test_a_search_that_is_cut_short_says_so() -> None:
    X, y = rows(30, 2, 2)
    with pytest.warns(ConvergenceWarning, match="L-BFGS stopped"):
        FusedNetwork(hidden_layer_sizes=(4,), solver="lbfgs", max_iter=2, random_state=0).fit(X, y)


def test_a_saturated_neuron_is_no_warning(recwarn: pytest.WarningsRecorder) -> None:
    X, y = rows(30, 2, 2)
    FusedNetwork(hidden_layer_sizes=(4,), activation="tanh", solver="lbfgs", max_iter=3, random_state=0).fit(1e4 * X, y)
    assert not [warning for warning in recwarn if issubclass(warning.category, RuntimeWarning)]


def test_another_loss_is_scikit_learns() -> None:
    X, y = rows(30, 2, 2)
    settings: dict[str, Any] = {"loss": "poisson", "hidden_layer_sizes": (4,), "solver": "lbfgs", "max_iter": 5}
    fused, expected = (kind(**settings, random_state=0).fit(X, np.square(y)) for kind in (FusedNetwork, MLPRegressor))
    np.testing.assert_array_equal(fused.predict(X), expected.predict(X))
