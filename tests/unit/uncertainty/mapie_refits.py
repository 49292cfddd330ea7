"""CV+ and jackknife+-after-bootstrap by MAPIE, from stored predictions of refits: what softkin's bounds must equal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Self

import numpy as np
from mapie import subsample
from mapie.regression import CrossConformalRegressor, JackknifeAfterBootstrapRegressor
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, RegressorMixin
from sklearn.model_selection import PredefinedSplit

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import FoldCalibration, RefitCalibration
from softkin.uncertainty.conformal import conformal_rank, engine_level, global_random_state_kept, unbounded


class Refits:
    """Stored predictions (n_rows,) by the rows that were fitted on; cloning it costs nothing.

    MAPIE also fits all rows, for a point prediction that no bound depends on: it gets `of_all`.
    """

    def __init__(self, predictions: Mapping[bytes, Array], of_all: Array) -> None:
        self.predictions = predictions
        self.of_all = of_all

    def __deepcopy__(self, memo: object) -> Self:
        return self


def key(rows: NDArray[Any]) -> bytes:
    return np.asarray(rows, dtype=np.int64).tobytes()


class Refitted(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """`fit(X, y)` looks up the refit on the rows numbered in X (n_rows, 1), `predict(X)` its predictions of others."""

    def __init__(self, refits: Refits) -> None:
        self.refits = refits

    def fit(self, X: Array, y: Array) -> Self:  # noqa: ARG002 (scikit-learn's signature)
        self.predictions_ = self.refits.predictions.get(key(X[:, 0]), self.refits.of_all)
        return self

    def predict(self, X: Array) -> Array:
        return self.predictions_[np.asarray(X)[:, 0].astype(np.int64)]


def intervals_by_mapie(data: RefitCalibration, confidence_levels: Sequence[float]) -> Array:
    """(n_levels, n_new, n_coordinates, 2); infinite at levels that `train` is too small for."""
    n = len(data.truth)
    result = unbounded(len(confidence_levels), data.new.shape[1:])
    ranks = {place: conformal_rank(n, level) for place, level in enumerate(confidence_levels)}
    finite = {place: engine_level(n, rank) for place, rank in ranks.items() if rank is not None}
    rows, new_rows = np.arange(n)[:, None], n + np.arange(data.new.shape[1])[:, None]
    together = np.concatenate([data.train, data.new], axis=1)
    for coordinate, true in enumerate(data.truth.T if finite else ()):
        predicted = together[..., coordinate]
        of_fits = {key(fitted_rows): of_fit for fitted_rows, of_fit in zip(data.fitted_rows, predicted, strict=True)}
        regressor = _regressor(data, Refitted(Refits(of_fits, predicted.mean(axis=0))), list(finite.values()))
        with global_random_state_kept():
            regressor.fit_conformalize(rows, true)
            _, bounds = regressor.predict_interval(new_rows)
        result[list(finite), :, coordinate] = np.moveaxis(bounds, 2, 0)
    return result


def _regressor(data: RefitCalibration, refitted: Refitted, levels: list[float]) -> Any:
    if not isinstance(data, FoldCalibration):
        return JackknifeAfterBootstrapRegressor(
            refitted, confidence_level=levels, method="plus", resampling=_resampling(data.fitted_rows)
        )
    fold_of_row = np.empty(len(data.truth), dtype=np.intp)
    for fold, fitted_rows in enumerate(data.fitted_rows):
        fold_of_row[np.setdiff1d(np.arange(len(fold_of_row)), fitted_rows)] = fold
    return CrossConformalRegressor(refitted, confidence_level=levels, method="plus", cv=PredefinedSplit(fold_of_row))


def _resampling(samples: Sequence[NDArray[np.intp]]) -> Any:
    class Subsample(subsample.Subsample):  # type: ignore[misc]  # MAPIE asks for the class by this name
        def split(self, X: Array, *_: Any, **__: Any) -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp]]]:
            for rows in samples:
                yield rows, np.setdiff1d(np.arange(len(X)), rows)

    return Subsample(n_resamplings=len(samples))
