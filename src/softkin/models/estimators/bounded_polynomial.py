"""Polynomial features of the commands, no more of them than the rows determine and the memory holds."""

from __future__ import annotations

import warnings
from typing import Self

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.preprocessing import PolynomialFeatures

from softkin.core.samples import Array
from softkin.models.estimators.polynomial_terms import Terms, bounded_terms, most_terms


class BoundedPolynomial(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """scikit-learn's PolynomialFeatures without the constant, of the terms that `bounded_terms` leaves of those asked
    for; what is left out is a warning, which the log of a fit shows.

    `degree`, `interaction_only` and `interactions` are those of `Terms`. Once fitted the terms are fixed.
    """

    def __init__(self, degree: int = 1, interaction_only: bool = False, interactions: bool = True) -> None:
        self.degree = degree
        self.interaction_only = interaction_only
        self.interactions = interactions

    def fit(self, X: Array, y: Array | None = None) -> Self:  # noqa: ARG002 (scikit-learn's signature)
        """Fix the terms by the number of rows of commands X (n_rows, n_commands)."""
        n_rows, n_commands = X.shape
        wanted = Terms(n_commands, self.degree, self.interaction_only, self.interactions)
        self.terms_ = bounded_terms(wanted, n_rows)
        if self.terms_ != wanted:
            warnings.warn(
                f"the polynomial of {n_commands} commands has {self.terms_} in place of {wanted}: a fit on {n_rows} "
                f"rows has {most_terms(n_rows)} terms at most",
                stacklevel=2,
            )
        self.features_ = PolynomialFeatures(
            self.terms_.degree, interaction_only=self.terms_.interaction_only, include_bias=False
        ).fit(X)
        return self

    def transform(self, X: Array) -> Array:
        """The terms (n_rows, n_terms) of commands X."""
        if self.terms_.interactions:
            return np.asarray(self.features_.transform(X))
        return np.hstack([X**power for power in range(1, self.terms_.degree + 1)])
