"""Polynomial trend with a regressor on its residuals: in extrapolation a tree then continues a trend, no constant."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, RegressorMixin, clone
from sklearn.linear_model import LinearRegression
from sklearn.pipeline import make_pipeline

from softkin.core.errors import ConfigError
from softkin.core.samples import Array, Params, Samples
from softkin.models.estimators.bounded_polynomial import BoundedPolynomial
from softkin.models.spec import TRENDS


class Detrended(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """A polynomial of `degree`, with or without `interactions` (see `BoundedPolynomial`), by least squares, and
    `regressor` on its residuals, standardised.

    Targets may be one (n_rows,) or many (n_rows, n_targets); a regressor of one target may predict several quantiles of
    it (n_rows, n_quantiles).
    """

    def __init__(self, regressor: Any, degree: int, interactions: bool = True) -> None:
        self.regressor = regressor
        self.degree = degree
        self.interactions = interactions

    def fit(self, X: Array, y: Array) -> Self:
        """Fit on commands X (n_rows, n_commands) and targets y."""
        terms = BoundedPolynomial(self.degree, interactions=self.interactions)
        self.trend_ = make_pipeline(terms, LinearRegression()).fit(X, y)
        residuals = y - self.trend_.predict(X)
        spread = residuals.std(axis=0)
        self.scale_ = np.where(spread > 0, spread, 1.0)
        self.regressor_ = clone(self.regressor).fit(X, residuals / self.scale_)
        return self

    def predict(self, X: Array) -> Array:
        """Targets, or their quantiles."""
        trend, rest = self.trend_.predict(X), np.asarray(self.regressor_.predict(X)) * self.scale_
        return np.asarray(trend[:, None] + rest if rest.ndim > trend.ndim else trend + rest)

    def residuals(self, samples: Samples) -> Samples:
        """What `regressor` is fitted on, of samples whose positions are targets (n_rows, n_targets)."""
        trend = self.trend_.predict(samples.commands).reshape(samples.positions.shape)
        return Samples(samples.commands, (samples.positions - trend) / self.scale_)


def detrended(build: Callable[[Params], Any], params: Params) -> Any:
    """The regressor that `build` makes of `params` without their `trend` (one of `TRENDS`, default none) and
    `interactions` (whether the trend has products of commands, default yes), on the residuals of that trend.

    Raises:
        ConfigError: there is no such trend.
    """
    rest = dict(params)
    trend, interactions = rest.pop("trend", TRENDS[0]), rest.pop("interactions", True)
    if trend not in TRENDS:
        raise ConfigError(f"'{trend}' is no trend", where="trend", fix=f"set one of {', '.join(TRENDS)}")
    degree = TRENDS.index(trend)
    return Detrended(build(rest), degree, interactions) if degree else build(rest)


def spread_around(
    spread: Callable[[Any, Samples, Array], Array], regressor: Any, train: Samples, commands: Array
) -> Array:
    """The `spread` (n_rows, n_targets) of a regressor that may be `Detrended`; the trend counts as known."""
    if not isinstance(regressor, Detrended):
        return spread(regressor, train, commands)
    return np.asarray(spread(regressor.regressor_, regressor.residuals(train), commands) * regressor.scale_)
