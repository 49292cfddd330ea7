"""Predictive interval of the model itself, of a Gaussian process or a Bayesian network, without calibration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import PredictiveCalibration
from softkin.uncertainty.intervals.spec import NO_GUARANTEE, IntervalMethod, Scaled


def intervals(data: PredictiveCalibration, confidence_levels: Sequence[float]) -> Array:
    """Prediction plus or minus a quantile of the normal distribution times the model's standard deviation."""
    from scipy.stats import norm

    halves = norm.ppf((1 + np.asarray(confidence_levels)) / 2)[:, None, None] * data.new_spread
    return np.stack([data.new - halves, data.new + halves], axis=-1)


def crps(data: PredictiveCalibration, true: Array) -> Array:
    """Continuous ranked probability score (n_rows, n_coordinates) in mm of the normal distribution.

    Source: Gneiting and Raftery (2007), equation 22. Where the standard deviation is 0, the absolute error.
    """
    from scipy.stats import norm

    error, std = true - data.new, data.new_spread
    z = error / np.where(std > 0, std, 1.0)
    score = std * (z * (2 * norm.cdf(z) - 1) + 2 * norm.pdf(z) - 1 / np.sqrt(np.pi))
    return np.where(std > 0, score, np.abs(error))


def scaled(data: PredictiveCalibration) -> Scaled:
    """The same in plain numbers."""
    n_coordinates = data.truth.shape[1]
    unit = replace(data, new=np.zeros((1, n_coordinates)), new_spread=np.ones((1, n_coordinates)))
    none = {"kind": "spread", "least": np.zeros(n_coordinates), "floor": 0.0}
    return Scaled(lambda confidence_levels: intervals(unit, confidence_levels)[:, 0], none)


METHOD = IntervalMethod(
    "gaussian",
    "Model's own interval",
    calibrated_on=PredictiveCalibration,
    guarantee=NO_GUARANTEE,
    intervals=intervals,
    crps=crps,
    scaled=scaled,
)
