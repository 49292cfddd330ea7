"""Intervals calibrated on all shells of `train`, which grow with the distance beyond it by an error-growth model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import Shell, ShellCalibration
from softkin.uncertainty.conformal import around, conformal_limits
from softkin.uncertainty.error_growth import ErrorGrowth, fit_error_growth, new_distances, shell_distances
from softkin.uncertainty.intervals.spec import NO_GUARANTEE, IntervalMethod


def intervals(data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    """Around the prediction of the model fitted on all of `train`, plus or minus `half_widths`."""
    return around(data.deployed.new, half_widths(data, confidence_levels))


def half_widths(data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    """(n_levels, n_rows, n_coordinates) in mm, non-decreasing along every ray that leaves the ball around `train`.

    Scores are the errors of each shell in units of what an error-growth model predicts at their distance. Each shell is
    calibrated by itself and the largest limit counts, which covers every mixture of shells (Duchi, Gupta, Jiang and Sur
    2024: predictive inference in multi-environment scenarios); a shell of too few rows for a level is ignored. Of the
    two error-growth models, one of each coordinate and one that all share, the wider interval is taken.
    """
    places, distances_of_new = shell_distances(data), new_distances(data)
    widest = np.zeros((len(confidence_levels), *data.deployed.new.shape))
    for growth in fit_error_growth(data):
        largest = largest_limits(data.shells, growth, places, confidence_levels)
        widest = np.maximum(widest, largest[:, None] * growth.of_new(distances_of_new))
    return widest


def largest_limits(
    shells: Sequence[Shell],
    growth: ErrorGrowth,
    places: Sequence[tuple[float, Array]],
    confidence_levels: Sequence[float],
) -> Array:
    """The largest limit (n_levels, n_coordinates) of the shells, of errors in units of what `growth` predicts at their
    `places`; infinite at a level for which all have too few rows.
    """
    limits = []
    for shell, (core, distances) in zip(shells, places, strict=True):
        scores = np.abs(shell.truth - shell.predicted) / growth.of_shell(core, distances)
        limits.append(conformal_limits(scores, confidence_levels))
    finite = np.where(np.isfinite(limits), limits, -np.inf).max(axis=0)
    return np.where(np.isfinite(finite), finite, np.inf)


METHOD = IntervalMethod(
    "rolling_shells",
    "Rolling outer shells",
    calibrated_on=ShellCalibration,
    guarantee=NO_GUARANTEE,
    intervals=intervals,
)
