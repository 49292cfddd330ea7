"""CV+ by MAPIE: each row of `train` is scored by the refit that holds it out; no calibration set is needed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import FoldCalibration
from softkin.uncertainty.conformal import columns, conformal_rank, engine_level, global_random_state_kept, unbounded
from softkin.uncertainty.intervals.spec import WEAK, IntervalMethod


def intervals(data: FoldCalibration, confidence_levels: Sequence[float]) -> Array:
    """Barber, Candes, Ramdas and Tibshirani (2021), section 3, one coordinate at a time, folds grouped by command.

    Its coverage is at least 1 - 2 alpha, in practice about 1 - alpha. Infinite where `train` is too small.
    Source: mapie.regression.CrossConformalRegressor with the method `plus`.
    """
    from mapie.regression import CrossConformalRegressor
    from sklearn.model_selection import PredefinedSplit

    from softkin.models.estimators.refitted import Refits, Refitted, key

    n = len(data.truth)
    result = unbounded(len(confidence_levels), data.new.shape[1:])
    ranks = {place: conformal_rank(n, level) for place, level in enumerate(confidence_levels)}
    finite = {place: engine_level(n, rank) for place, rank in ranks.items() if rank is not None}
    fold_of_row = np.empty(n, dtype=np.intp)
    for fold, fitted_rows in enumerate(data.fitted_rows):
        fold_of_row[np.setdiff1d(np.arange(n), fitted_rows)] = fold
    rows, new_rows = np.arange(n)[:, None], n + np.arange(data.new.shape[1])[:, None]
    together = np.concatenate([data.train, data.new], axis=1)
    for coordinate, true in enumerate(columns(data.truth)):
        predicted = together[..., coordinate]
        refits = Refits(
            {key(fitted_rows): of_fit for fitted_rows, of_fit in zip(data.fitted_rows, predicted, strict=True)},
            predicted.mean(axis=0),
        )
        regressor = CrossConformalRegressor(
            Refitted(refits), confidence_level=list(finite.values()), method="plus", cv=PredefinedSplit(fold_of_row)
        )
        with global_random_state_kept():
            regressor.fit_conformalize(rows, true)
            _, bounds = regressor.predict_interval(new_rows)
        result[list(finite), :, coordinate] = np.moveaxis(bounds, 2, 0)
    return result


METHOD = IntervalMethod("cv_plus", "CV+", calibrated_on=FoldCalibration, guarantee=WEAK, intervals=intervals)
