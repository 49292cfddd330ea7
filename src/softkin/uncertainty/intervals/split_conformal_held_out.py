"""Normalised split conformal prediction: wider where the model erred more on held-out rows of `train`."""

from __future__ import annotations

from collections.abc import Sequence

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import HeldOutCalibration
from softkin.uncertainty.conformal import TINY, conformal_rank, normalised_intervals, normalised_sides
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod, Scaled


def intervals(data: HeldOutCalibration, confidence_levels: Sequence[float]) -> Array:
    """Half-width proportional to the mean error near the command, coordinate by coordinate.

    The errors are those of the model's study on held-out folds of `train`, and the calibration set has no part in them.
    Where they do not tell hard commands from easy ones, the width is constant, as of split conformal prediction.
    Source: Papadopoulos, Vovk and Gammerman (2011); crepes.ConformalRegressor with `sigmas`.
    """
    of = data.difficulty.of
    return normalised_intervals(data, confidence_levels, of(data.calibration_commands), of(data.new_commands))


def scaled(data: HeldOutCalibration) -> Scaled:
    """The same in plain numbers."""
    difficulty = data.difficulty.of(data.calibration_commands)
    return Scaled(
        lambda confidence_levels: normalised_sides(data, difficulty, confidence_levels),
        {"kind": "held_out", "floor": TINY} | data.difficulty.numbers,
    )


METHOD = IntervalMethod(
    "scp_held_out",
    "SCP, by held-out errors",
    calibrated_on=HeldOutCalibration,
    guarantee=MARGINAL,
    intervals=intervals,
    rank=conformal_rank,
    scaled=scaled,
)
