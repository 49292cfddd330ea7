"""Calibration data: what an interval method is calibrated on, one class for each kind.

Calibration rows have true positions; new rows get intervals. Positions and spreads are
(n_rows, n_coordinates) in mm, commands (n_rows, n_commands), quantiles (n_levels, n_rows, n_coordinates, 2) in mm.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.held_out_difficulty import HeldOutDifficulty

Rows = NDArray[np.intp]


class CalibrationData:
    """Base class of the kinds of calibration data.

    `is_around_a_model`: intervals lie around the prediction of a point model, not of a quantile regressor.
    `is_for_extrapolation`: it serves commands in extrapolation, and adds nothing in-domain.
    `has_spread`: it holds the spread of the model at each command.
    `needs_quantiles`, `needs_refits`, `needs_shells`, `needs_held_out`: it is read from quantile regressors, from
    refits of a model on folds or bootstrap samples, from refits on cores of `train`, or from what its study predicted
    of held-out folds. Calibration rows are those of `train` where it needs refits, else those of `validation`.
    """

    is_around_a_model: ClassVar[bool] = True
    is_for_extrapolation: ClassVar[bool] = False
    has_spread: ClassVar[bool] = False
    needs_quantiles: ClassVar[bool] = False
    needs_refits: ClassVar[bool] = False
    needs_shells: ClassVar[bool] = False
    needs_held_out: ClassVar[bool] = False


@dataclass(frozen=True)
class PointCalibration(CalibrationData):
    """Predicted positions of calibration rows (`calibration`) with their `truth`, and of new rows (`new`)."""

    calibration: Array
    truth: Array
    new: Array
    train_commands: Array
    calibration_commands: Array
    new_commands: Array

    def resplit(self, calibration_rows: Rows, held_out_rows: Rows) -> Self:
        """Calibration data on some of the calibration rows, with the held-out ones as new rows."""
        return replace(
            self,
            calibration=self.calibration[calibration_rows],
            truth=self.truth[calibration_rows],
            new=self.calibration[held_out_rows],
            calibration_commands=self.calibration_commands[calibration_rows],
            new_commands=self.calibration_commands[held_out_rows],
        )


@dataclass(frozen=True)
class HeldOutCalibration(PointCalibration):
    """Predicted positions of a searched model, and how hard commands are for it by its errors on held-out folds."""

    difficulty: HeldOutDifficulty

    needs_held_out: ClassVar[bool] = True


@dataclass(frozen=True)
class SpreadCalibration(PointCalibration):
    """Predicted positions of a model with a spread, and that spread, in mm, on every row."""

    train_spread: Array
    calibration_spread: Array
    new_spread: Array

    has_spread: ClassVar[bool] = True

    def resplit(self, calibration_rows: Rows, held_out_rows: Rows) -> Self:
        """As for predicted positions; spreads are split with them."""
        return replace(
            super().resplit(calibration_rows, held_out_rows),
            calibration_spread=self.calibration_spread[calibration_rows],
            new_spread=self.calibration_spread[held_out_rows],
        )


@dataclass(frozen=True)
class PredictiveCalibration(SpreadCalibration):
    """Predicted positions of a model whose spread is the standard deviation of a predictive distribution."""


@dataclass(frozen=True)
class QuantileCalibration(CalibrationData):
    """Predicted quantiles of calibration rows with their true positions `truth`, and of new rows, at the confidence
    `levels` that they were fitted for.
    """

    calibration: Array
    truth: Array
    new: Array
    levels: Sequence[float]

    is_around_a_model: ClassVar[bool] = False
    needs_quantiles: ClassVar[bool] = True

    def resplit(self, calibration_rows: Rows, held_out_rows: Rows) -> Self:
        """Calibration data on some of the calibration rows, with the held-out ones as new rows."""
        return replace(
            self,
            calibration=self.calibration[:, calibration_rows],
            truth=self.truth[calibration_rows],
            new=self.calibration[:, held_out_rows],
        )


@dataclass(frozen=True)
class RefitCalibration(CalibrationData):
    """A point model refitted on several parts of `train`.

    `fitted_rows` holds the rows of `train` of each fit; `train` (n_fits, n_train, n_coordinates) and `new` (n_fits,
    n_new, n_coordinates) its predictions; `truth` (n_train, n_coordinates); in mm.
    """

    fitted_rows: Sequence[Rows]
    train: Array
    truth: Array
    new: Array

    needs_refits: ClassVar[bool] = True


@dataclass(frozen=True)
class FoldCalibration(RefitCalibration):
    """Each fit leaves out one fold of `train`; each row is left out by one fit."""


@dataclass(frozen=True)
class ResampleCalibration(RefitCalibration):
    """Each fit is on a bootstrap sample of `train`; each row is left out by at least one fit."""


@dataclass(frozen=True)
class Shell:
    """What a model fitted on an inner core of `train` predicts of the shell around it.

    `predicted` and `truth` are (n_shell, n_coordinates) in mm, `core_commands` and `commands` (n_rows, n_commands).
    """

    core_commands: Array
    commands: Array
    predicted: Array
    truth: Array


@dataclass(frozen=True)
class ShellCalibration(CalibrationData):
    """The `deployed` model, fitted on all of `train`, and the same model fitted on its cores, the smallest first.

    `norm` maps commands (n_rows, n_commands) to their command norms (n_rows,). `in_domain` (n_levels, n_rows,
    n_coordinates, 2) are the bounds of in-domain rows; None: those of split conformal prediction.
    `in_domain_has_spread` says that those bounds widen with the spread of the model, not with the distance alone.
    """

    deployed: PointCalibration
    shells: Sequence[Shell]
    norm: Callable[[Array], Array]
    in_domain: Array | None = None
    in_domain_has_spread: bool = False

    is_for_extrapolation: ClassVar[bool] = True
    needs_shells: ClassVar[bool] = True
