"""Log marginal likelihood of the kernels of the Gaussian process, with its gradient.

scikit-learn's likelihood serves any kernel, and holds an array (n_rows, n_rows, n_hyperparameters) of gradients that it
multiplies per coordinate; kept libraries that do better need torch, JAX or TensorFlow. Of a sum of terms that all
coordinates share, the gradient needs one matrix: with K = L L' and A = sum over coordinates of (K^-1 y) (K^-1 y)' -
n_coordinates K^-1, the derivative in a hyperparameter t is tr(A dK/dt) / 2 (Rasmussen and Williams 2006, equation 5.9).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Protocol

import numpy as np
from scipy.linalg import cho_solve
from scipy.linalg.lapack import dpotrf, dpotri

from softkin.core.samples import Array


class Term(Protocol):
    """A summand of the kernel, of hyperparameters theta (n_theta,): logarithms, in scikit-learn's order."""

    n_theta: int

    def matrix(self, theta: Array) -> Array:
        """Its kernel matrix (n_rows, n_rows) at these hyperparameters."""
        ...

    def derivatives(self, weights: Array) -> Array:
        """Sums of `weights` (n_rows, n_rows) times the derivatives of the last matrix: (n_theta,)."""
        ...


class Likelihood:
    """Negative log marginal likelihood of `terms` plus white noise plus `jitter` on the diagonal, of y (n_rows,
    n_coordinates), summed over coordinates; the noise is the last of the hyperparameters.
    """

    def __init__(self, terms: Sequence[Term], y: Array, jitter: float) -> None:
        self.terms, self.y, self.jitter = terms, y, jitter

    def __call__(self, theta: Array) -> tuple[float, Array]:
        """Value and gradient (n_theta,) at theta; infinite, and no slope, where K cannot be factorised."""
        parts = np.split(theta[:-1], np.cumsum([term.n_theta for term in self.terms])[:-1])
        noise = float(np.exp(theta[-1]))
        kernel = np.zeros((len(self.y), len(self.y)))
        for term, part in zip(self.terms, parts, strict=True):
            kernel += term.matrix(part)
        kernel[np.diag_indices_from(kernel)] += noise + self.jitter
        lower, failed = dpotrf(kernel, lower=True, clean=True)
        if failed:
            return np.inf, np.zeros_like(theta)
        n_rows, n_coordinates = self.y.shape
        solved = cho_solve((lower, True), self.y, check_finite=False)
        value = 0.5 * np.vdot(self.y, solved)
        value += n_coordinates * (np.log(np.diag(lower)).sum() + 0.5 * n_rows * np.log(2 * np.pi))
        inverse, _ = dpotri(lower, lower=True)  # and zeros above the diagonal
        diagonal = np.diag(inverse).copy()
        inverse = inverse + inverse.T
        np.fill_diagonal(inverse, diagonal)
        weights = solved @ solved.T - n_coordinates * inverse
        slopes = [term.derivatives(weights) for term in self.terms]
        return float(value), -0.5 * np.concatenate([*slopes, [noise * np.trace(weights)]])


class Polynomial:
    """variance * (x x' + bias^2)^degree, a linear (1) or quadratic (2) trend; theta: log variance, log bias."""

    n_theta = 2

    def __init__(self, X: Array, degree: int) -> None:
        self.products, self.degree = X @ X.T, degree

    def matrix(self, theta: Array) -> Array:
        """See `Term`."""
        self.variance, self.bias = np.exp(theta)
        self.base = self.products + self.bias**2
        self.value = self.variance * self.base**self.degree
        return np.asarray(self.value)

    def derivatives(self, weights: Array) -> Array:
        """See `Term`."""
        by_base = self.degree * self.variance * (weights.sum() if self.degree == 1 else np.vdot(weights, self.base))
        return np.array([np.vdot(weights, self.value), 2 * self.bias**2 * by_base])


class Linear:
    """x x' + bias^2, the paper's kernel; theta: log bias."""

    n_theta = 1

    def __init__(self, X: Array) -> None:
        self.products = X @ X.T

    def matrix(self, theta: Array) -> Array:
        """See `Term`."""
        self.bias = float(np.exp(theta[0]))
        return np.asarray(self.products + self.bias**2)

    def derivatives(self, weights: Array) -> Array:
        """See `Term`."""
        return np.array([2 * self.bias**2 * weights.sum()])


class Stationary:
    """variance * shape(distance in units of a length scale per command); theta: log variance, log length scales."""

    def __init__(self, X: Array, shape: Callable[[Array], tuple[Array, Array]]) -> None:
        self.squares = np.square(X.T[:, :, None] - X.T[:, None, :]).reshape(X.shape[1], -1)
        self.shape, self.n_rows, self.n_theta = shape, len(X), 1 + X.shape[1]

    def matrix(self, theta: Array) -> Array:
        """See `Term`."""
        self.variance, self.inverse_squares = np.exp(theta[0]), np.exp(-2 * theta[1:])
        value, slope = self.shape(self.inverse_squares @ self.squares)
        self.value, self.slope = self.variance * value, self.variance * slope
        return np.asarray(self.value.reshape(self.n_rows, self.n_rows))

    def derivatives(self, weights: Array) -> Array:
        """See `Term`."""
        flat = weights.ravel()
        return np.array([flat @ self.value, *(self.inverse_squares * (self.squares @ (flat * self.slope)))])


class RationalQuadratic:
    """variance * (1 + d^2 / (2 alpha l^2))^-alpha; theta: log variance, log alpha, log l."""

    n_theta = 3

    def __init__(self, X: Array) -> None:
        self.squares = np.square(X[:, None] - X[None]).sum(axis=-1)

    def matrix(self, theta: Array) -> Array:
        """See `Term`."""
        variance, self.alpha, length = np.exp(theta)
        self.scaled = self.squares / (2 * self.alpha * length**2)
        self.base = 1 + self.scaled
        self.value = variance * self.base**-self.alpha
        return np.asarray(self.value)

    def derivatives(self, weights: Array) -> Array:
        """See `Term`."""
        weighted = weights * self.value
        share = self.alpha * np.vdot(weighted, self.scaled / self.base)
        by_alpha = share - self.alpha * np.vdot(weighted, np.log(self.base))
        return np.array([weighted.sum(), by_alpha, 2 * share])


def rbf(squares: Array) -> tuple[Array, Array]:
    """exp(-d^2 / 2) of squared distances, and minus twice its derivative in d^2."""
    value = np.exp(-0.5 * squares)
    return value, value


def matern32(squares: Array) -> tuple[Array, Array]:
    """(1 + a) exp(-a), a = sqrt(3) d, and minus twice its derivative in d^2."""
    distance = np.sqrt(3 * squares)
    decay = np.exp(-distance)
    return (1 + distance) * decay, 3 * decay


def matern52(squares: Array) -> tuple[Array, Array]:
    """(1 + a + a^2 / 3) exp(-a), a = sqrt(5) d, and minus twice its derivative in d^2."""
    distance = np.sqrt(5 * squares)
    decay = np.exp(-distance)
    return (1 + distance + distance**2 / 3) * decay, 5 / 3 * (1 + distance) * decay


#: The stationary term of a kernel's name, of commands X (n_rows, n_commands).
SHAPES: dict[str, Callable[[Array], Any]] = {
    "rbf": partial(Stationary, shape=rbf),
    "matern32": partial(Stationary, shape=matern32),
    "matern52": partial(Stationary, shape=matern52),
    "rational_quadratic": RationalQuadratic,
}
#: The terms of a trend's name.
TREND_TERMS: dict[str, list[Callable[[Array], Any]]] = {
    "none": [],
    "linear": [partial(Polynomial, degree=1)],
    "quadratic": [partial(Polynomial, degree=2)],
}
