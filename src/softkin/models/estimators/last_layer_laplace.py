"""Laplace approximation of a network's last layer: a Bayesian network at the cost of one Cholesky factor."""

from __future__ import annotations

import copy

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.special import expit
from sklearn.neural_network import MLPRegressor

from softkin.core.samples import Array, Samples

ACTIVATIONS = {"tanh": np.tanh, "logistic": expit, "relu": lambda values: np.maximum(values, 0.0)}
#: Least precision of a weight's prior, relative to the mean of the data's: dead neurons would leave it singular.
LEAST_PRECISION = 1e-9


def last_layer_laplace(network: MLPRegressor, train: Samples, commands: Array) -> Array:
    """Standard deviation of the predictive distribution (n_rows, n_coordinates), in the units of `train`.

    The network minimises |residuals|^2 + alpha |weights|^2, so the posterior of its last layer, hidden layers as
    fitted, is normal around its weights with covariance noise^2 (H'H + alpha)^-1, H its last hidden outputs on `train`
    and a one. The noise is that of its own residuals there, a coordinate at a time, for the degrees of freedom left.
    Source: Daxberger et al. (2021), Laplace Redux, section 3; for a Gaussian likelihood it is exact.
    """
    factor, noise = last_layer_posterior(network, train)
    new = _hidden(network, commands)
    leverage = np.einsum("ij,ji->i", new, cho_solve(factor, new.T))
    return np.asarray(np.sqrt(1.0 + leverage)[:, None] * noise)


def last_layer_posterior(network: MLPRegressor, train: Samples) -> tuple[tuple[Array, bool], Array]:
    """Cholesky factor of the precision of the last layer's weights, as `cho_factor` gives it, in units of the noise;
    and the noise (n_coordinates,).
    """
    known = _hidden(network, train.commands)
    gram = known.T @ known
    penalty = np.full(len(gram), max(float(network.alpha), LEAST_PRECISION * float(np.trace(gram)) / len(gram)))
    penalty[-1] = 0.0  # the bias is free
    factor = cho_factor(gram + np.diag(penalty))
    residuals = train.positions - network.predict(train.commands).reshape(train.positions.shape)
    freedom = max(1.0, len(known) - float(np.trace(cho_solve(factor, gram))))
    return factor, np.sqrt((residuals**2).sum(axis=0) / freedom)


def _hidden(network: MLPRegressor, commands: Array) -> Array:
    """Outputs (n_rows, width + 1) of the last hidden layer, and a one for the bias."""
    headless = copy.copy(network)
    headless.coefs_, headless.intercepts_ = network.coefs_[:-1], network.intercepts_[:-1]
    headless.n_layers_, headless.n_outputs_ = network.n_layers_ - 1, network.coefs_[-1].shape[0]
    outputs = ACTIVATIONS[network.activation](headless.predict(commands).reshape(len(commands), -1))
    return np.column_stack([outputs, np.ones(len(commands))])
