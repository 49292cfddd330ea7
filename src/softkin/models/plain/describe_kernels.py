"""What fitted kernel machines, Gaussian processes and support vectors, are in plain numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from softkin.core.errors import ConfigError
from softkin.core.samples import Samples
from softkin.models.plain.describe_expansion import expanded
from softkin.models.plain.kernels import Node


def of_gaussian_process(estimators: Sequence[Any], known: Samples | None) -> Node:
    """Of a Gaussian process of all targets."""
    posterior = estimators[0].posterior_
    points = posterior.X_train_
    terms, noise = terms_of(posterior.kernel_, points.shape[1])
    weights = posterior.alpha_.reshape(len(points), -1)
    node: Node = {
        "kind": "kernel",
        "points": points,
        "terms": terms,
        "weights": weights,
        "constant": np.zeros(weights.shape[1]),
    }
    if (parts := expanded(points, terms, weights)) is not None:
        node["expansion"] = parts
    if known is not None:
        trained = posterior.y_train_.reshape(weights.shape)
        node |= {"factor": posterior.L_, "noise": noise, "factors": np.sqrt((trained * weights).mean(axis=0))}
    return node


def terms_of(kernel: Any, n_features: int, constant: float = 1.0) -> tuple[list[Node], float]:
    """Terms of a kernel of scikit-learn times a constant, and the variance of its noise.

    Raises:
        ConfigError: it has a part of another kind.
    """
    name, ones = type(kernel).__name__, np.ones(n_features)
    term: Node = {"constant": constant}
    if name == "Sum":
        (first, one), (second, other) = (terms_of(part, n_features, constant) for part in (kernel.k1, kernel.k2))
        return first + second, one + other
    if name == "Product" and type(kernel.k1).__name__ == "ConstantKernel":
        return terms_of(kernel.k2, n_features, constant * kernel.k1.constant_value)
    if name == "WhiteKernel":
        return [], constant * kernel.noise_level
    if name == "RBF":
        return [term | {"shape": "exponential", "lengths": ones * kernel.length_scale, "rate": 0.5}], 0.0
    if name == "Matern" and kernel.nu in (1.5, 2.5):
        return [term | {"shape": f"matern{2 * kernel.nu:.0f}2", "lengths": ones * kernel.length_scale}], 0.0
    if name == "RationalQuadratic":
        rate = 2 * kernel.alpha * kernel.length_scale**2
        return [term | {"shape": "rational", "lengths": ones, "rate": rate, "power": kernel.alpha}], 0.0
    base, power = (kernel.kernel, kernel.exponent) if name == "Exponentiation" else (kernel, 1)
    if type(base).__name__ == "DotProduct":
        return [term | {"shape": "product", "rate": 1.0, "offset": base.sigma_0**2, "power": int(power)}], 0.0
    raise ConfigError(
        f"a kernel {kernel} cannot be written as plain numbers",
        where="BoundedGaussianProcess",
        fix="use a kernel of the search space of the Gaussian process",
    )


def of_support_vectors(estimators: Sequence[Any], known: Samples | None) -> Node:
    """Of a support vector regression for each target, on the same rows: all their support vectors together.

    Raises:
        ConfigError: it has a kernel that no description is known of.
    """
    first = estimators[0]
    rows = np.unique(np.concatenate([one.support_ for one in estimators]))
    points, weights = np.empty((len(rows), first.n_features_in_)), np.zeros((len(rows), len(estimators)))
    for target, one in enumerate(estimators):
        places = np.searchsorted(rows, one.support_)
        points[places], weights[places, target] = one.support_vectors_, one.dual_coef_[0]
    ones = np.ones(points.shape[1])
    shapes: dict[str, Node] = {
        "rbf": {"shape": "exponential", "lengths": ones, "rate": first._gamma},
        "poly": {"shape": "product", "rate": first._gamma, "offset": float(first.coef0), "power": first.degree},
        "linear": {"shape": "product", "rate": 1.0, "offset": 0.0, "power": 1},
    }
    if first.kernel not in shapes:
        raise ConfigError(
            f"a kernel '{first.kernel}' cannot be written as plain numbers",
            where="SVR",
            fix=f"use one of {', '.join(shapes)}",
        )
    return {
        "kind": "kernel",
        "points": points,
        "terms": [{"constant": 1.0} | shapes[first.kernel]],
        "weights": weights,
        "constant": np.concatenate([one.intercept_ for one in estimators]),
    }
