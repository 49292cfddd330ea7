"""Bounds of CV+ and jackknife+-after-bootstrap: those of a model that was refitted on parts of `train`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import RefitCalibration
from softkin.uncertainty.conformal import conformal_rank, unbounded

#: New rows whose candidates for bounds are held at a time.
N_ROWS = 512


def plus_intervals(data: RefitCalibration, confidence_levels: Sequence[float]) -> Array:
    """Intervals (n_levels, n_new, n_coordinates, 2) in mm, one coordinate at a time.

    Each row of `train` has a score, the absolute residual of the mean of the refits that hold it out. Around the mean
    of the same refits on a new row, plus and minus the score, lie the candidates for a bound: the k-th smallest upper
    one is the upper bound, the k-th largest lower one the lower, k being the conformal rank. Infinite where `train` is
    too small for a level.
    Source: Barber, Candes, Ramdas and Tibshirani (2021), section 3; Kim, Xu and Barber (2020); mapie.regression 1.6,
    method `plus` and aggregation `mean`, whose bounds these are to the bit, which a test holds.
    """
    n_train, n_new, n_coordinates = len(data.truth), data.new.shape[1], data.truth.shape[1]
    result = unbounded(len(confidence_levels), (n_new, n_coordinates))
    ranks = {place: conformal_rank(n_train, level) for place, level in enumerate(confidence_levels)}
    finite = {place: rank for place, rank in ranks.items() if rank is not None}
    if not finite:
        return result
    is_held_out = np.ones((n_train, len(data.fitted_rows)), dtype=bool)
    for fit, fitted_rows in enumerate(data.fitted_rows):
        is_held_out[fitted_rows, fit] = False
    weights = (is_held_out / is_held_out.sum(axis=1, keepdims=True)).T
    places, highest = list(finite), np.array(list(finite.values())) - 1
    lowest = n_train - 1 - highest
    for coordinate in range(n_coordinates):
        held_out = np.nanmean(np.where(is_held_out, data.train[..., coordinate].T, np.nan), axis=1)
        scores = np.abs(data.truth[:, coordinate] - held_out)
        # In one product, as MAPIE's: the last bit of a sum depends on how many rows BLAS is given.
        centres = np.ascontiguousarray(data.new[..., coordinate].T) @ weights
        for start in range(0, n_new, N_ROWS):
            rows = slice(start, start + N_ROWS)
            lower = np.partition(centres[rows] - scores, lowest, axis=1)[:, lowest]
            upper = np.partition(centres[rows] + scores, highest, axis=1)[:, highest]
            result[places, rows, coordinate] = np.stack([lower.T, upper.T], axis=-1)
    return result
