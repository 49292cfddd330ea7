"""The shared vocabulary: subsets, samples, models. Imports nothing of ours.

Array shapes, stated once: commands ``(n_rows, n_commands)``; positions ``(n_rows, n_coordinates)`` in mm with
``n_coordinates = 3 * n_markers``, ordered m1_x, m1_y, m1_z, m2_x, ...
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from optuna.trial import BaseTrial

Array = NDArray[np.float64]
Params = dict[str, Any]

TRAIN, VALIDATION, TEST, EXTRAPOLATION = SUBSETS = ("train", "validation", "test", "extrapolation")
PAPER, TUNED = PRESETS = ("paper", "tuned")

#: A coordinate whose range on `train` stays below this (mm) is constant: it says nothing about a model.
CONSTANT_RANGE_MM = 1e-6


class SoftkinError(Exception):
    """Bad input, told so that a person can mend it: what is wrong, where, and what to do."""


@dataclass(frozen=True, slots=True)
class Samples:
    """Rows of one subset: `commands` (n_rows, n_commands), `positions` (n_rows, n_coordinates) in mm."""

    commands: Array
    positions: Array

    def __len__(self) -> int:
        return len(self.commands)


@dataclass(frozen=True, slots=True)
class ModelSpec:
    """One model of the pool.

    `build(params, seed, threads)` returns an unfitted multi-output scikit-learn regressor that works in
    standardised space. `paper_params` are the fixed settings of the paper's rows. `search_space(trial)` draws the
    parameters of a tuned model; `first_trials` are drawn before it samples on its own.
    """

    name: str
    title: str
    family: str
    build: Callable[[Params, int, int], Any]
    paper_params: Params
    search_space: Callable[[BaseTrial], Params]
    first_trials: tuple[Mapping[str, Any], ...]


def command_columns(n_commands: int) -> list[str]:
    """Names u1, u2, ... of the command columns."""
    return [f"u{i + 1}" for i in range(n_commands)]


def coordinate_columns(n_markers: int) -> list[str]:
    """Names m1_x, m1_y, m1_z, m2_x, ... of the coordinate columns."""
    return [f"m{i + 1}_{axis}" for i in range(n_markers) for axis in "xyz"]


def informative_coordinates(train_positions: Array) -> NDArray[np.bool_]:
    """Mask (n_coordinates,) of the coordinates that move on `train` (range above `CONSTANT_RANGE_MM`)."""
    return np.asarray(np.ptp(train_positions, axis=0) > CONSTANT_RANGE_MM)


@dataclass(frozen=True, slots=True)
class QuantileSpec:
    """One learner of quantiles. `build(params, quantiles, seed, threads)` returns an unfitted regressor of one
    coordinate, in standardised space, that predicts (n_rows, n_quantiles).
    """

    name: str
    title: str
    build: Callable[[Params, Sequence[float], int, int], Any]
    paper_params: Params


@dataclass(frozen=True, slots=True)
class Evidence:
    """What an interval method sees of one fitted model: its output on `validation` with the truth, and on new rows.

    `calibration` and `new` are predicted positions (n_rows, n_coordinates) for a method on predictions, or predicted
    quantiles (n_levels, n_rows, n_coordinates, 2) for a method on quantiles; `truth` is (n_calibration,
    n_coordinates); all in mm.
    """

    calibration: Array
    truth: Array
    new: Array


@dataclass(frozen=True, slots=True)
class IntervalMethod:
    """One way to put an interval around a predicted position.

    `intervals(evidence, confidence_levels)` returns (n_levels, n_rows, n_coordinates, 2), lower and upper in mm,
    levels ascending. `on` says what it starts from: `predictions` or `quantiles`. `guaranteed` says whether its
    coverage of a coordinate is at least the level for rows exchangeable with those of `validation`.
    """

    name: str
    title: str
    on: str
    guaranteed: bool
    intervals: Callable[[Evidence, Sequence[float]], Array]
