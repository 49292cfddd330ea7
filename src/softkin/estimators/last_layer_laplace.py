"""The Laplace approximation of a network's last layer: a Bayesian network for the price of a ridge regression."""

from __future__ import annotations

import copy

import numpy as np
from scipy.special import expit
from sklearn.linear_model import BayesianRidge
from sklearn.neural_network import MLPRegressor

from softkin.interface import Array, Samples

ACTIVATIONS = {"tanh": np.tanh, "logistic": expit, "relu": lambda values: np.maximum(values, 0.0)}


def last_layer_laplace(network: MLPRegressor, train: Samples, commands: Array) -> Array:
    """Standard deviation of the predictive distribution (n_rows, n_coordinates), in the units of `train`.

    The hidden layers stay as fitted; the weights of the last layer get the Gaussian posterior that a linear model on
    their outputs has, prior and noise by maximum evidence, a coordinate at a time.
    Source: Daxberger et al. (2021), Laplace Redux, section 3 (for a Gaussian likelihood the approximation is exact);
    sklearn.linear_model.BayesianRidge.
    """
    known, new = (_hidden(network, rows) for rows in (train.commands, commands))
    spreads = [
        BayesianRidge().fit(known, coordinate).predict(new, return_std=True)[1] for coordinate in train.positions.T
    ]
    return np.column_stack(spreads)


def _hidden(network: MLPRegressor, commands: Array) -> Array:
    """Outputs (n_rows, width) of the last hidden layer."""
    headless = copy.copy(network)
    headless.coefs_, headless.intercepts_ = network.coefs_[:-1], network.intercepts_[:-1]
    headless.n_layers_, headless.n_outputs_ = network.n_layers_ - 1, network.coefs_[-1].shape[0]
    return np.asarray(ACTIVATIONS[network.activation](headless.predict(commands).reshape(len(commands), -1)))
