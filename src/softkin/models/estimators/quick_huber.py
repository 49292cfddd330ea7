"""scikit-learn's robust regression, equal to the bit in two thirds of the time."""

from __future__ import annotations

import warnings
from typing import Self

import numpy as np
from numpy.typing import NDArray
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import HuberRegressor

from softkin.core.samples import Array
from softkin.models.estimators.quick_lbfgs import quick_lbfgs

#: The scale is positive: it is bounded by this many times the spacing of numbers at 1, as in scikit-learn.
LEAST_SCALE = 10 * float(np.finfo(np.float64).eps)


class HuberLoss:
    """Huber's loss of coefficients, intercept and scale, and its gradient, of rows X (n_rows, n_features), y (n_rows,).

    The same operations on the same numbers as scikit-learn's, sparse and weighted rows left out. Rows within epsilon
    scales and those beyond are kept apart from one call to the next: near the optimum few calls change them. Source:
    scikit-learn 1.9, `_huber_loss_and_gradient`; Huber and Ronchetti (2009), eq. 7.2.
    """

    def __init__(self, X: Array, y: Array, *, epsilon: float, alpha: float) -> None:
        self.X, self.y, self.epsilon, self.alpha = X, y, epsilon, alpha
        self._outlying: NDArray[np.bool_] | None = None
        self._near, self._far = X, X[:0]

    def __call__(self, packed: Array) -> tuple[float, Array]:
        """Loss and gradient (n_features + 2,) at `packed`: coefficients, intercept, scale."""
        weights, scale, epsilon = packed[:-2], packed[-1], self.epsilon
        residuals = self.y - self.X @ weights
        residuals -= packed[-2]
        sizes = np.abs(residuals)
        outlying = sizes > epsilon * scale
        within = ~outlying
        if self._outlying is None or not np.array_equal(outlying, self._outlying):
            self._outlying, self._near, self._far = outlying, self.X[within], self.X[outlying]
        n_far = len(self._far)
        near = residuals[within]
        squared = np.dot(near, near) / scale
        signs = np.where(residuals[outlying] < 0, -1.0, 1.0)

        gradient = np.empty(len(packed))
        # Of zero minus the product: its sign is the only thing that scikit-learn's -X changes.
        gradient[:-2] = 2.0 / scale * -(near @ self._near)
        gradient[:-2] -= 2.0 * epsilon * (signs @ self._far)
        gradient[:-2] += self.alpha * 2.0 * weights
        gradient[-1] = len(self.y)
        gradient[-1] -= n_far * epsilon**2
        gradient[-1] -= squared / scale
        gradient[-2] = -2.0 * np.sum(near) / scale
        gradient[-2] -= 2.0 * epsilon * np.sum(signs)
        far_loss = 2.0 * epsilon * np.sum(sizes[outlying]) - scale * n_far * epsilon**2
        loss = len(self.y) * scale + squared + far_loss
        loss += self.alpha * np.dot(weights, weights)
        return float(loss), gradient


class QuickHuber(HuberRegressor):  # type: ignore[misc]
    """HuberRegressor that minimises `HuberLoss` by the same L-BFGS; what that does not know is left to scikit-learn."""

    def fit(self, X: Array, y: Array, sample_weight: Array | None = None) -> Self:
        """Fit on X (n_rows, n_features) and y (n_rows,), weighted by `sample_weight` (n_rows,).

        Raises:
            ValueError: L-BFGS breaks down.
        """
        if sample_weight is not None or self.warm_start or not self.fit_intercept:
            return self._of_scikit_learn(X, y, sample_weight)
        start = np.zeros(X.shape[1] + 2)
        start[-1] = 1
        least = np.full(len(start), -np.inf)
        least[-1] = LEAST_SCALE
        loss = HuberLoss(X, y, epsilon=self.epsilon, alpha=self.alpha)
        optimum = quick_lbfgs(
            loss, start, max_iter=self.max_iter, tolerance=self.tol, bounds=(least, np.full_like(least, np.inf))
        )
        if optimum.status == 2:  # scikit-learn comes to the same end, and says why
            return self._of_scikit_learn(X, y, None)
        if optimum.status:
            warnings.warn(f"L-BFGS stopped: {optimum.message}", ConvergenceWarning, stacklevel=2)
        self.n_features_in_, self.n_iter_ = X.shape[1], min(optimum.nit, self.max_iter)
        self.coef_, self.intercept_, self.scale_ = optimum.x[:-2], optimum.x[-2], optimum.x[-1]
        residuals = np.abs(y - X @ self.coef_ - self.intercept_)
        self.outliers_ = residuals > self.scale_ * self.epsilon
        return self

    def _of_scikit_learn(self, X: Array, y: Array, sample_weight: Array | None) -> Self:
        super().fit(X, y, sample_weight)
        return self
