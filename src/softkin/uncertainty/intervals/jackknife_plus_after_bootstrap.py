"""Jackknife+-after-bootstrap by MAPIE: each row of `train` is scored by the refits that hold it out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import ResampleCalibration
from softkin.uncertainty.conformal import columns, conformal_rank, engine_level, global_random_state_kept, unbounded
from softkin.uncertainty.intervals.spec import WEAK, IntervalMethod


def intervals(data: ResampleCalibration, confidence_levels: Sequence[float]) -> Array:
    """Kim, Xu and Barber (2020), one coordinate at a time, predictions averaged over refits.

    The interval goes around the average of the refits, not around the model fitted on all rows. Its coverage is at
    least 1 - 2 alpha, in practice about 1 - alpha. Infinite where `train` is too small.
    Source: mapie.regression.JackknifeAfterBootstrapRegressor.
    """
    from mapie.regression import JackknifeAfterBootstrapRegressor

    from softkin.models.estimators.refitted import Refits, Refitted, key

    n = len(data.truth)
    result = unbounded(len(confidence_levels), data.new.shape[1:])
    ranks = {place: conformal_rank(n, level) for place, level in enumerate(confidence_levels)}
    finite = {place: engine_level(n, rank) for place, rank in ranks.items() if rank is not None}
    rows, new_rows = np.arange(n)[:, None], n + np.arange(data.new.shape[1])[:, None]
    together = np.concatenate([data.train, data.new], axis=1)
    for coordinate, true in enumerate(columns(data.truth)):
        predicted = together[..., coordinate]
        refits = Refits(
            {key(fitted_rows): of_fit for fitted_rows, of_fit in zip(data.fitted_rows, predicted, strict=True)},
            predicted.mean(axis=0),
        )
        regressor = JackknifeAfterBootstrapRegressor(
            Refitted(refits), confidence_level=list(finite.values()), resampling=_resampling(data.fitted_rows)
        )
        with global_random_state_kept():
            regressor.fit_conformalize(rows, true)
            _, bounds = regressor.predict_interval(new_rows)
        result[list(finite), :, coordinate] = np.moveaxis(bounds, 2, 0)
    return result


def _resampling(samples: Sequence[NDArray[np.intp]]) -> Any:
    """MAPIE's resampling object, which returns the bootstrap `samples` that the models were refitted on."""
    from mapie import subsample

    class Subsample(subsample.Subsample):  # type: ignore[misc]  # MAPIE asks for the class by this name
        def split(self, X: Array, *_: Any, **__: Any) -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp]]]:
            for rows in samples:
                yield rows, np.setdiff1d(np.arange(len(X)), rows)

    return Subsample(n_resamplings=len(samples))


METHOD = IntervalMethod(
    "jackknife_plus_ab",
    "Jackknife+-after-bootstrap",
    calibrated_on=ResampleCalibration,
    guarantee=WEAK,
    intervals=intervals,
)
