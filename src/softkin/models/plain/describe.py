"""Registry of what fitted estimators are in plain numbers: one line for each class, read by its name.

A describer takes the fitted estimators of one kind, one of all targets or one for each, and what spreads are relative
to: the rows that they were fitted on, standardised; None where no spread is asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from softkin.core.errors import ConfigError
from softkin.core.samples import Array, Samples
from softkin.models.plain import describe_kernels, describe_trees
from softkin.models.plain.kernels import Node

#: Regressors of several targets that hold one estimator for each.
PER_TARGET = ("PerTarget", "SupportVectors")
Describer = Callable[[Sequence[Any], "Samples | None"], Node]


def described(estimator: Any, known: Samples | None = None) -> Node:
    """The node of a fitted estimator of standardised targets; with `known`, and the numbers of its spread.

    Raises:
        ConfigError: there is no describer for its class.
    """
    name = type(estimator).__name__
    estimators = estimator.estimators_ if name in PER_TARGET else [estimator]
    name = type(estimators[0]).__name__
    if name not in DESCRIBERS:
        raise ConfigError(
            f"a {name} cannot be written as plain numbers: no describer of it is known",
            where=type(estimator).__name__,
            fix=f"use a model of one of these: {', '.join(DESCRIBERS)}",
        )
    return DESCRIBERS[name](estimators, known)


def of_pipeline(estimators: Sequence[Any], known: Samples | None) -> Node:
    """Of a BoundedPolynomial, a StandardScaler or none, and a linear model."""
    first, *between = (step for _, step in estimators[0].steps)
    last, scalers = between[-1], between[:-1]
    node = described(last, known)
    n_features = first.features_.n_features_in_
    if first.terms_.interactions:
        powers = first.features_.powers_
    else:
        powers = np.vstack([power * np.eye(n_features, dtype=int) for power in range(1, first.terms_.degree + 1)])
    node |= {"factors": _factors(powers), "n_features": n_features}
    for scaler in scalers:
        node |= {"mean": scaler.mean_, "scale": scaler.scale_}
    return node


def of_linear(estimators: Sequence[Any], known: Samples | None) -> Node:
    """Of linear models of the features."""
    weights = np.column_stack([np.atleast_2d(one.coef_).T for one in estimators])
    constant = np.concatenate([np.ravel(one.intercept_) for one in estimators])
    n_features = len(weights)
    return {
        "kind": "polynomial",
        "n_features": n_features,
        "factors": _factors(np.eye(n_features, dtype=int)),
        "mean": np.zeros(n_features),
        "scale": np.ones(n_features),
        "weights": weights,
        "constant": np.broadcast_to(constant, weights.shape[1:]).copy(),
    }


def of_network(estimators: Sequence[Any], known: Samples | None) -> Node:
    """Of a multi-layer perceptron of all targets."""
    network = estimators[0]
    node: Node = {
        "kind": "network",
        "weights": list(network.coefs_),
        "biases": list(network.intercepts_),
        "activation": network.activation,
    }
    if known is not None:
        from softkin.models.estimators.last_layer_laplace import last_layer_posterior

        (upper, _), noise = last_layer_posterior(network, known)
        node |= {"factor": np.triu(upper).T.copy(), "noise": noise}
    return node


def of_equals(estimators: Sequence[Any], known: Samples | None) -> Node:
    """Of several estimators whose mean counts."""
    members = [described(member, known) for member in estimators[0].estimators_]
    return {"kind": "mean", "members": members, "shares": np.full(len(members), 1 / len(members))}


def of_detrended(estimators: Sequence[Any], known: Samples | None) -> Node:
    """Of a trend and a regressor of its residuals."""
    detrended = estimators[0]
    rest = described(detrended.regressor_, None if known is None else detrended.residuals(known))
    trend, scale = described(detrended.trend_), np.atleast_1d(detrended.scale_)
    return {"kind": "detrended", "trend": trend, "rest": rest, "scale": scale}


def _factors(powers: Any) -> Any:
    """Places (n_terms, degree) of the factors of each term, of its powers (n_terms, n_features)."""
    n_features, degree = powers.shape[1], int(powers.sum(axis=1).max())
    factors = np.full((len(powers), degree), n_features)
    for term, row in zip(factors, powers, strict=True):
        places = np.repeat(np.arange(n_features), row)
        term[: len(places)] = places
    return factors


def numbers_in(node: Any) -> int:
    """How many numbers a node holds."""
    if isinstance(node, dict):
        return sum(map(numbers_in, node.values()))
    if isinstance(node, list):
        return sum(map(numbers_in, node))
    return int(np.size(node)) if isinstance(node, np.ndarray) else 1


def standardised(scaler: Any, inner: Node) -> Node:
    """A node behind the scaler of its features."""
    mean: Array = scaler.mean_
    return {"kind": "standardised", "mean": mean, "scale": scaler.scale_, "inner": inner}


DESCRIBERS: dict[str, Describer] = {
    "Pipeline": of_pipeline,
    "LinearRegression": of_linear,
    "Lasso": of_linear,
    "Ridge": of_linear,
    "HuberRegressor": of_linear,  # of models that an earlier version wrote
    "QuickHuber": of_linear,
    "BoundedGaussianProcess": describe_kernels.of_gaussian_process,
    "SVR": describe_kernels.of_support_vectors,
    "MLPRegressor": of_network,
    "FusedNetwork": of_network,
    "BaggingRegressor": of_equals,
    "Detrended": of_detrended,
    "RandomForestRegressor": describe_trees.of_forest,  # this and the next three of earlier versions
    "GradientBoostingRegressor": describe_trees.of_gradient_boosting,
    "HistGradientBoostingRegressor": describe_trees.of_histogram_boosting,
    "XGBRegressor": describe_trees.of_xgboost,
    "QuickForest": describe_trees.of_forest,
    "QuickBoosting": describe_trees.of_gradient_boosting,
    "QuickHistograms": describe_trees.of_histogram_boosting,
    "QuickXGBoost": describe_trees.of_xgboost,
}
