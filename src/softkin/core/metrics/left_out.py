"""Metrics with each single row left out in turn. Arrays are (n_rows, n_coordinates) in mm unless said otherwise."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sklearn.metrics import r2_score

from softkin.core.metrics.point import euclidean_errors
from softkin.core.samples import Array, measured_coordinates


def without_each_row(values: Array) -> Array:
    """Means (n_rows, ...) of `values` (n_rows, ...) over all rows but one, for each row.

    Means with each row in turn added last, so that a row far larger than all others takes no digits from them.
    """
    n_rows = len(values)
    before = np.concatenate([np.zeros_like(values[:1]), np.cumsum(values, axis=0)[:-1]])
    after = np.concatenate([np.cumsum(values[::-1], axis=0)[::-1][1:], np.zeros_like(values[:1])])
    return np.asarray((before + after) / (n_rows - 1))


def point_metrics_without_each_row(true: Array, predicted: Array, informative: NDArray[np.bool_]) -> dict[str, Array]:
    """RMSE, MAE and mean Euclidean error as in point_metrics.csv, each (n_rows,), with that row left out; mm."""
    errors = (predicted - true)[:, measured_coordinates(true)]
    markers = informative.reshape(-1, 3).any(axis=1)
    return {
        "rmse_mm": np.sqrt(without_each_row(np.square(errors))).mean(axis=1),
        "mae_mm": without_each_row(np.abs(errors)).mean(axis=1),
        "euclidean_mean_mm": without_each_row(euclidean_errors(true, predicted)[:, markers]).mean(axis=1),
    }


def r2_without_each_coordinate(true: Array, predicted: Array) -> Array:
    """R2 averaged over all coordinates but one, (n_coordinates,)."""
    return without_each_row(np.asarray(r2_score(true, predicted, multioutput="raw_values"), dtype=np.float64))
