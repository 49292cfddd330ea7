"""Calibrated on all shells of `train`, with intervals that grow with the distance beyond what was fitted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import ShellCalibration
from softkin.uncertainty.conformal import around, conformal_limits
from softkin.uncertainty.error_growth import growth_laws, new_distances, shell_distances
from softkin.uncertainty.intervals.spec import NO_GUARANTEE, IntervalMethod


def intervals(data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    """Around what the model of all of `train` predicts, as wide as `half_widths` says."""
    return around(data.deployed.new, half_widths(data, confidence_levels))


def half_widths(data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    """(n_levels, n_rows, n_coordinates) in mm, non-decreasing along every ray that leaves the ball around `train`.

    Scores are the errors of each shell in units of what an error-growth model makes of its distance. Each shell is
    calibrated by itself and the widest counts, which covers every mixture of shells (Duchi, Gupta, Jiang and Sur 2024:
    predictive inference in multi-environment scenarios); a shell of too few rows for a level is ignored. Of the two
    models, one of each coordinate and one that all share, the wider is taken.
    """
    places, beyond = shell_distances(data), new_distances(data)
    widest = np.zeros((len(confidence_levels), *data.deployed.new.shape))
    for law in growth_laws(data):
        limits = []
        for shell, (reach, distances) in zip(data.shells, places, strict=True):
            scores = np.abs(shell.truth - shell.predicted) / law.of_shell(reach, distances)
            limits.append(conformal_limits(scores, confidence_levels))
        finite = np.where(np.isfinite(limits), limits, -np.inf).max(axis=0)
        worst = np.where(np.isfinite(finite), finite, np.inf)
        widest = np.maximum(widest, worst[:, None] * law.of_new(beyond))
    return widest


METHOD = IntervalMethod(
    "rolling_shells", "By rolling shells", calibrated_on=ShellCalibration, guarantee=NO_GUARANTEE, intervals=intervals
)
