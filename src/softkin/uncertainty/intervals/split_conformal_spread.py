"""Normalised split conformal prediction: wider where the spread of the model is large."""

from __future__ import annotations

from collections.abc import Sequence

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import SpreadCalibration
from softkin.uncertainty.conformal import TINY, conformal_rank, normalised_intervals, normalised_sides
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod, Scaled

#: Added to every spread, as a share of its mean over `train`: the trees of a forest may agree by chance.
LEAST_SHARE = 0.1


def intervals(data: SpreadCalibration, confidence_levels: Sequence[float]) -> Array:
    """Half-width proportional to the spread of the model: of the trees of a forest, the posterior of a Gaussian process
    or the last layer of a network.

    Source: Lei et al. (2018), section 5.2; crepes.ConformalRegressor with `sigmas`.
    """
    least = LEAST_SHARE * data.train_spread.mean(axis=0)
    return normalised_intervals(data, confidence_levels, data.calibration_spread + least, data.new_spread + least)


def scaled(data: SpreadCalibration) -> Scaled:
    """The same in plain numbers."""
    least = LEAST_SHARE * data.train_spread.mean(axis=0)
    return Scaled(
        lambda confidence_levels: normalised_sides(data, data.calibration_spread + least, confidence_levels),
        {"kind": "spread", "least": least, "floor": TINY},
    )


METHOD = IntervalMethod(
    "scp_spread",
    "SCP, by spread",
    calibrated_on=SpreadCalibration,
    guarantee=MARGINAL,
    intervals=intervals,
    rank=conformal_rank,
    scaled=scaled,
)
