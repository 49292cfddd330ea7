"""Split conformal prediction in units of the distance of a command from the mean command of `train`."""
# To add an interval method: copy this file to src/softkin/uncertainty/intervals/<name>.py, fill in what the comments
# name, and add to src/softkin/uncertainty/intervals/__init__.py the import of the module and the line
#     "my_method": my_method.METHOD,
# Then name it in `interval_methods` of config/config.yaml, and run:
# pytest tests/contract/test_interval_methods.py -k my_method

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import PointCalibration
from softkin.uncertainty.conformal import around, conformal_limits, conformal_rank
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod

#: Difficulty of the mean command, where 1 is that of a command one standard deviation away.
LEAST_DIFFICULTY = 0.5


# The class of `data` says what the method is calibrated on: predictions (PointCalibration), with the model's spread
# (SpreadCalibration, PredictiveCalibration), quantiles, refits on folds or resamples, or shells of `train`.
def intervals(data: PointCalibration, confidence_levels: Sequence[float]) -> Array:
    """Bounds (n_levels, n_rows, n_coordinates, 2) in mm: half-width proportional to the difficulty of a command.

    Source: the paper that the method is from, and the equation or section of it.
    """
    centre, scale = data.train_commands.mean(axis=0), data.train_commands.std(axis=0)

    def difficulty(commands: Array) -> Array:
        return np.asarray(LEAST_DIFFICULTY + np.linalg.norm((commands - centre) / scale, axis=1, keepdims=True))

    # The true positions of new rows are not there to be looked at; those of the calibration rows are `data.truth`.
    scores = np.abs(data.truth - data.calibration) / difficulty(data.calibration_commands)
    # The score of rank ceil(level (n + 1)) of each level and coordinate, infinite where n is too small for it.
    limits = conformal_limits(scores, confidence_levels)
    return around(data.new, limits[:, None] * difficulty(data.new_commands))


METHOD = IntervalMethod(
    # The key in the registry, and what tables and figures call it.
    "my_method",
    "My method",
    calibrated_on=PointCalibration,
    # MARGINAL only where it is proven: tests hold the method to it. NO_GUARANTEE otherwise.
    guarantee=MARGINAL,
    intervals=intervals,
    # The rank that its coverage follows from; leave it out for a method that calibrates nothing.
    rank=conformal_rank,
    # Optional: has_constant_width=True for one half-width on every row, `crps` for a whole distribution.
)
