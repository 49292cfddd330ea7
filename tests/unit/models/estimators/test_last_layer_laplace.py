from __future__ import annotations

import numpy as np
import pytest
from sklearn.exceptions import ConvergenceWarning
from sklearn.neural_network import MLPRegressor

from softkin.core.samples import Samples
from softkin.models.estimators.last_layer_laplace import ACTIVATIONS, last_layer_laplace


@pytest.mark.filterwarnings("ignore::sklearn.exceptions.ConvergenceWarning")
@pytest.mark.parametrize("activation", ACTIVATIONS)
@pytest.mark.parametrize("n_outputs", [1, 3])
def test_it_is_the_posterior_of_a_ridge_regression_on_the_last_hidden_layer(activation: str, n_outputs: int) -> None:
    rng = np.random.default_rng(0)
    rows = Samples(rng.uniform(-1, 1, (80, 2)), rng.standard_normal((80, n_outputs)))
    targets = rows.positions if n_outputs > 1 else rows.positions.ravel()
    network = MLPRegressor(
        hidden_layer_sizes=(6, 5), activation=activation, solver="lbfgs", max_iter=50, random_state=0
    )
    network.fit(rows.commands, targets)
    before = network.predict(rows.commands).copy()
    hidden = rows.commands
    for weights, bias in zip(network.coefs_[:-1], network.intercepts_[:-1], strict=True):
        hidden = ACTIVATIONS[activation](hidden @ weights + bias)
    np.testing.assert_allclose(
        (hidden @ network.coefs_[-1] + network.intercepts_[-1]).reshape(before.shape), before, atol=1e-10
    )
    design = np.column_stack([hidden, np.ones(80)])
    precision = design.T @ design + np.diag([1e-4] * 5 + [0.0])
    residuals = rows.positions[:, 0] - before.reshape(80, -1)[:, 0]
    inverse = np.linalg.inv(precision)
    freedom = 80 - np.trace(inverse @ design.T @ design)
    expected = np.sqrt((residuals**2).sum() / freedom * (1 + np.diag(design @ inverse @ design.T)))
    std = last_layer_laplace(network, rows, rows.commands)
    assert std.shape == (80, n_outputs)
    np.testing.assert_allclose(std[:, 0], expected, rtol=1e-5)
    np.testing.assert_array_equal(network.predict(rows.commands), before)  # the network is left as it was


def test_it_is_surer_where_it_was_trained() -> None:
    rng = np.random.default_rng(0)
    commands = rng.uniform(-1, 1, (200, 1))
    rows = Samples(commands, np.sin(3 * commands) + 0.05 * rng.standard_normal((200, 1)))
    network = MLPRegressor(hidden_layer_sizes=(16,), activation="tanh", solver="lbfgs", max_iter=5000, random_state=0)
    network.fit(rows.commands, rows.positions.ravel())
    near, far = last_layer_laplace(network, rows, np.array([[0.0], [2.0]]))[:, 0]
    assert near == pytest.approx(0.05, rel=0.4)
    assert far > 2 * near


def test_a_dead_neuron_does_not_stop_it() -> None:
    rng = np.random.default_rng(0)
    rows = Samples(rng.uniform(-1, 1, (50, 2)), rng.standard_normal((50, 2)))
    network = MLPRegressor(hidden_layer_sizes=(4,), activation="relu", alpha=0.0, max_iter=5, random_state=0)
    with pytest.warns(ConvergenceWarning):
        network.fit(rows.commands, rows.positions)
    network.coefs_[0][:, 0], network.intercepts_[0][0] = 0.0, -1.0
    assert np.isfinite(last_layer_laplace(network, rows, rows.commands)).all()
