"""Intervals calibrated on an outer shell of `train`: errors of a model fitted on the core within it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import Shell, ShellCalibration
from softkin.uncertainty.conformal import around, conformal_limits
from softkin.uncertainty.error_growth import new_distances, train_radius
from softkin.uncertainty.intervals.spec import NO_GUARANTEE, IntervalMethod

CORE_SHARE = 0.7


def intervals(data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    """Of constant width, around the prediction of the model fitted on all of `train`.

    The half-width is the conformal quantile of the absolute residuals of the model of a core on its shell; the core is
    that nearest to 70 % of the rows of `train`. It covers as asked if new commands relate to `train` as the shell to
    its core, which nothing guarantees.
    """

    def difference(shell: Shell) -> float:
        n_core = len(shell.core_commands)
        return abs(n_core / (n_core + len(shell.commands)) - CORE_SHARE)

    return _calibrated_on(min(data.shells, key=difference), data, confidence_levels)


def matched_intervals(data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    """As `intervals`, with the core for which radius of `train` / radius of the core is nearest, in logarithms, to the
    largest distance of the new commands. It is transductive: it looks at all new commands, at none of their positions,
    before any of them gets an interval.
    """
    largest_distance = np.log(new_distances(data).max())

    def difference(shell: Shell) -> float:
        return float(abs(np.log(train_radius(data) / data.norm(shell.core_commands).max()) - largest_distance))

    return _calibrated_on(min(data.shells, key=difference), data, confidence_levels)


def _calibrated_on(shell: Shell, data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    limits = conformal_limits(np.abs(shell.truth - shell.predicted), confidence_levels)
    return around(data.deployed.new, np.broadcast_to(limits[:, None], (len(limits), *data.deployed.new.shape)))


METHOD = IntervalMethod(
    "shell",
    "Outer shell",
    calibrated_on=ShellCalibration,
    guarantee=NO_GUARANTEE,
    intervals=intervals,
    has_constant_width=True,
)
MATCHED = IntervalMethod(
    "shell_matched",
    "Matched outer shell",
    calibrated_on=ShellCalibration,
    guarantee=NO_GUARANTEE,
    intervals=matched_intervals,
    has_constant_width=True,
)
