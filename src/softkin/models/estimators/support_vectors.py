"""Support vector regression of several targets, whose kernel is computed once where it was fitted on many rows."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from sklearn.metrics.pairwise import pairwise_kernels

from softkin.core.rows import MANY_ROWS, PART, in_parts
from softkin.core.samples import Array
from softkin.models.estimators.per_target import PerTarget

#: Kernels that scikit-learn computes outside libsvm, too.
KERNELS = ("linear", "poly", "rbf")


class SupportVectors(PerTarget):
    """`PerTarget` of a support vector regression.

    libsvm computes the kernel of each row with each support vector target by target, one number after the other. Of
    more fitted rows than `MANY_ROWS` the kernel with all support vectors is computed once for all targets, by matrix
    products: the same up to rounding, in a tenth of the time. Of fewer, predictions are libsvm's to the bit.
    """

    def fit(self, X: Array, y: Array) -> Self:
        """Fit on commands X (n_rows, n_commands) and targets y (n_rows, n_targets), or (n_rows,) of one target."""
        super().fit(X, y)
        self.is_large_ = len(X) > MANY_ROWS and self.regressor.kernel in KERNELS
        if self.is_large_:
            self._put_together()
        return self

    def predict(self, X: Array) -> Array:
        """Targets in the shape of y."""
        if not self.is_large_:
            return super().predict(X)
        first = self.estimators_[0]
        how: dict[str, Any] = {"gamma": first._gamma, "degree": first.degree, "coef0": first.coef0}
        kernels = (
            pairwise_kernels(part, self.points_, metric=first.kernel, filter_params=True, **how)
            for part in in_parts(X, PART)
        )
        predicted = np.concatenate([kernel @ self.weights_ + self.constant_ for kernel in kernels])
        return predicted[:, 0] if self.is_flat_ else predicted

    def _put_together(self) -> None:
        """The support vectors `points_` (n_points, n_commands) of all targets, their `weights_` (n_points, n_targets)
        and the `constant_` (n_targets,).
        """
        rows = np.unique(np.concatenate([estimator.support_ for estimator in self.estimators_]))
        self.points_ = np.empty((len(rows), self.estimators_[0].n_features_in_))
        self.weights_ = np.zeros((len(rows), len(self.estimators_)))
        for target, estimator in enumerate(self.estimators_):
            places = np.searchsorted(rows, estimator.support_)
            self.points_[places], self.weights_[places, target] = estimator.support_vectors_, estimator.dual_coef_[0]
        self.constant_ = np.concatenate([estimator.intercept_ for estimator in self.estimators_])
