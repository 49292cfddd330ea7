"""Exact Gaussian process with bounded cost of the likelihood search."""

from __future__ import annotations

import logging
from typing import Any, Self

import numpy as np
from scipy.linalg import LinAlgError
from sklearn.base import BaseEstimator, RegressorMixin
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import (
    RBF,
    ConstantKernel,
    DotProduct,
    Exponentiation,
    Kernel,
    Matern,
    RationalQuadratic,
    WhiteKernel,
)

from softkin.core.rows import MANY_ROWS, PART, in_parts
from softkin.core.samples import Array
from softkin.models.estimators.kernel_likelihood import SHAPES, TREND_TERMS, Likelihood, Linear
from softkin.models.estimators.quick_lbfgs import quick_lbfgs

logger = logging.getLogger("softkin")

LENGTH_SCALE_BOUNDS = (1e-2, 1e3)
NOISE_BOUNDS = (1e-10, 1.0)
#: Scaled objective of a kernel that cannot be factorised: worse than any, and finite for the line search.
SINGULAR = 1e6
#: Largest slope of the scaled objective that counts as none: scipy's own.
TOLERANCE = 1e-5
#: Rows predicted at once, where as many as published robots have are fitted on.
ROWS_AT_ONCE = 10_000
JITTERS = (1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5)


class BoundedGaussianProcess(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """Learns the kernel by maximum likelihood on at most `learning_rows` rows, then conditions on all rows.

    The kernel is shared by all coordinates, so each likelihood and the final posterior need one Cholesky factor
    (Rasmussen and Williams 2006, Algorithm 2.1).

    Parameters:
        kernel: none, rbf, matern32, matern52 (a length scale per command) or rational_quadratic.
        trend: the kernel that is added: none, linear or quadratic; paper_linear is the bare
            DotProduct() + WhiteKernel() of the paper.
        initial_length_scale: where the search for length scales starts, in standard deviations of a command.
        initial_noise: where the search for the noise variance starts, in variances of a coordinate.
        learning_rows: rows at most that the likelihood is computed on.
        max_iter: bound on the iterations of L-BFGS.
        random_state: seed of the draw of those rows.
    """

    def __init__(
        self,
        kernel: str = "rbf",
        trend: str = "none",
        initial_length_scale: float = 1.0,
        initial_noise: float = 1e-3,
        learning_rows: int = 300,
        max_iter: int = 40,
        random_state: int = 0,
    ) -> None:
        self.kernel = kernel
        self.trend = trend
        self.initial_length_scale = initial_length_scale
        self.initial_noise = initial_noise
        self.learning_rows = learning_rows
        self.max_iter = max_iter
        self.random_state = random_state

    def fit(self, X: Array, y: Array) -> Self:
        """Fit on commands X (n_rows, n_commands) and positions y (n_rows, n_coordinates), both standardised."""
        rows = np.arange(len(X))
        if len(rows) > self.learning_rows:
            rng = np.random.default_rng(self.random_state)
            rows = np.sort(rng.choice(rows, self.learning_rows, replace=False))
        self.posterior_ = _conditioned(self._learnt_kernel(X[rows], y[rows].reshape(len(rows), -1)), X, y)
        return self

    def predict(self, X: Array) -> Array:
        """Posterior mean (n_rows, n_coordinates)."""
        return np.concatenate([self.posterior_.predict(part) for part in self._parts(X)])

    def predict_std(self, X: Array) -> Array:
        """Standard deviation (n_rows, n_coordinates) of the posterior predictive distribution, noise included.

        The shared kernel fixes it but for one factor per coordinate, its maximum-likelihood estimate: the root of
        y' K^-1 y / n (Rasmussen and Williams 2006, section 5.4.1).
        """
        std = np.concatenate([self.posterior_.predict(part, return_std=True)[1] for part in self._parts(X)])
        trained = self.posterior_.y_train_.reshape(len(self.posterior_.X_train_), -1)
        factors = np.sqrt((trained * self.posterior_.alpha_.reshape(trained.shape)).mean(axis=0))
        return np.asarray(std.reshape(len(X), -1)[:, :1] * factors)

    def _parts(self, X: Array) -> list[Array]:
        """The rows in parts whose kernel with the trained rows fits into memory."""
        return in_parts(X, PART if len(self.posterior_.X_train_) > MANY_ROWS else ROWS_AT_ONCE)

    def _kernel(self, n_commands: int) -> Kernel:
        if self.trend == "paper_linear":
            return DotProduct() + WhiteKernel()
        scale = np.full(n_commands, self.initial_length_scale)
        shapes: dict[str, Any] = {
            "rbf": lambda: RBF(scale, LENGTH_SCALE_BOUNDS),
            "matern32": lambda: Matern(scale, LENGTH_SCALE_BOUNDS, nu=1.5),
            "matern52": lambda: Matern(scale, LENGTH_SCALE_BOUNDS, nu=2.5),
            "rational_quadratic": lambda: RationalQuadratic(self.initial_length_scale, 1.0, LENGTH_SCALE_BOUNDS),
        }
        trends: dict[str, Any] = {
            "linear": lambda: ConstantKernel() * DotProduct(),
            "quadratic": lambda: ConstantKernel() * Exponentiation(DotProduct(), 2),
        }
        kernel = ConstantKernel() * shapes[self.kernel]() + WhiteKernel(self.initial_noise, NOISE_BOUNDS)
        return kernel if self.trend == "none" else trends[self.trend]() + kernel

    def _terms(self, X: Array) -> list[Any]:
        """The terms of the likelihood that `_kernel` is the sum of, but for the noise."""
        if self.trend == "paper_linear":
            return [Linear(X)]
        return [*(term(X) for term in TREND_TERMS[self.trend]), SHAPES[self.kernel](X)]

    def _learnt_kernel(self, X: Array, y: Array) -> Kernel:
        """The kernel of largest likelihood, with the smallest jitter that lets its matrix be factorised.

        L-BFGS-B minimises the objective per observation. Unscaled, the gradient grows with the number of rows and the
        first step of a bounded problem lands on the bounds, where the kernel is singular and the search gives up (seen
        with scipy 1.17).
        """
        kernel, terms = self._kernel(X.shape[1]), self._terms(X)
        for jitter in JITTERS:
            objective = Likelihood(terms, y, jitter)
            scale = max(1.0, abs(objective(kernel.theta)[0]))
            scale = scale if np.isfinite(scale) else 1.0

            def scaled(theta: Array, objective: Likelihood = objective, scale: float = scale) -> tuple[float, Array]:
                value, gradient = objective(theta)
                return (value / scale, gradient / scale) if np.isfinite(value) else (SINGULAR, gradient)

            low, high = np.transpose(kernel.bounds)
            found = quick_lbfgs(scaled, kernel.theta, max_iter=self.max_iter, tolerance=TOLERANCE, bounds=(low, high))
            if np.isfinite(objective(found.x)[0]):
                return kernel.clone_with_theta(found.x)
        raise _singular(kernel)


class _Posterior(GaussianProcessRegressor):  # type: ignore[misc]
    """scikit-learn's regressor at a kernel that is learnt: its likelihood, a second factor of the same matrix, is not
    computed.
    """

    def log_marginal_likelihood(self, *args: Any, **kwargs: Any) -> float:  # noqa: ARG002 (scikit-learn's signature)
        return float("nan")


def _conditioned(kernel: Kernel, X: Array, y: Array) -> GaussianProcessRegressor:
    """The posterior with the smallest jitter that lets the kernel's matrix be factorised."""
    for jitter in JITTERS:
        try:
            return _Posterior(kernel, alpha=jitter, optimizer=None).fit(X, y)
        except LinAlgError:
            logger.debug("kernel %s is not positive definite with jitter %g", kernel, jitter)
    raise _singular(kernel)


def _singular(kernel: Kernel) -> LinAlgError:
    return LinAlgError(f"kernel {kernel} is not positive definite, even with jitter {JITTERS[-1]} on its diagonal")
