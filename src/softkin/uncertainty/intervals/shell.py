"""Calibrated on a shell of `train`: what a model fitted on the inner commands gets wrong on those around them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import Shell, ShellCalibration
from softkin.uncertainty.conformal import around, conformal_limits
from softkin.uncertainty.error_growth import new_distances, reach
from softkin.uncertainty.intervals.spec import NO_GUARANTEE, IntervalMethod

CORE_SHARE = 0.7


def intervals(data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    """Of constant width: the conformal quantile of the absolute residuals that the model of a core has on its shell,
    around what the model of all of `train` predicts. The core is that nearest to 70 % of the rows of `train`.

    It would hold if new commands were to `train` what the shell is to its core; that is likely, and not guaranteed.
    """

    def off(shell: Shell) -> float:
        core = len(shell.core_commands)
        return abs(core / (core + len(shell.commands)) - CORE_SHARE)

    return _calibrated_on(min(data.shells, key=off), data, confidence_levels)


def matched_intervals(data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    """Likewise, with the core whose shell reaches as far beyond it, relatively, as the new commands reach beyond
    `train`. It looks at the new commands, not at their positions.
    """
    wanted = np.log(new_distances(data).max())

    def off(shell: Shell) -> float:
        return float(abs(np.log(reach(data) / data.norm(shell.core_commands).max()) - wanted))

    return _calibrated_on(min(data.shells, key=off), data, confidence_levels)


def _calibrated_on(shell: Shell, data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    limits = conformal_limits(np.abs(shell.truth - shell.predicted), confidence_levels)
    return around(data.deployed.new, np.broadcast_to(limits[:, None], (len(limits), *data.deployed.new.shape)))


METHOD = IntervalMethod(
    "shell",
    "By a shell of train",
    calibrated_on=ShellCalibration,
    guarantee=NO_GUARANTEE,
    intervals=intervals,
    has_constant_width=True,
)
MATCHED = IntervalMethod(
    "shell_matched",
    "By a matched shell",
    calibrated_on=ShellCalibration,
    guarantee=NO_GUARANTEE,
    intervals=matched_intervals,
    has_constant_width=True,
)
