"""Put a calibration set around a fitted model: a calibrated model."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from softkin.core.samples import Array, Samples, informative_coordinates
from softkin.models.spec import PointModel
from softkin.training.predict import rows_with_spread, spread_of
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.calibration_data import Shell
from softkin.uncertainty.conformal import error_scale
from softkin.uncertainty.failures import FailureClass
from softkin.uncertainty.held_out_difficulty import HeldOutDifficulty
from softkin.uncertainty.intervals.spec import IntervalMethod
from softkin.uncertainty.joint_region import joint_region
from softkin.uncertainty.promise import Promise


@dataclass(frozen=True, slots=True)
class FittedModel:
    """A fitted point model: its entry in the registry, preset, estimator, rows of `train`; how hard commands are for
    it, by its errors on held-out folds of `train`, where that is known.
    """

    dataset: str
    spec: PointModel
    preset: str
    estimator: Any
    train: Samples
    difficulty: HeldOutDifficulty | None = None

    def spread(self, inputs: Array) -> Array:
        """Spread of the model at inputs (n_rows, n_inputs): (n_rows, n_coordinates) in mm."""
        return spread_of(self.spec, self.estimator, self.train, inputs)


def calibrated(
    model: FittedModel,
    method: IntervalMethod[Any],
    validation: Samples,
    shells: Sequence[Shell] = (),
    norm: Callable[[Array], Array] | None = None,
    about: Mapping[str, Any] | None = None,
    promise: Promise | None = None,
    failures: FailureClass | None = None,
) -> CalibratedModel:
    """The calibrated model around a fitted model, with its predictions on `train` and `validation` stored.

    Parameters:
        model: the fitted point model.
        method: an interval method around a point model; its kind of calibration data decides whether spreads are used.
        validation: the calibration set.
        shells: what the same model predicts beyond cores of `train`, the smallest core first.
        norm: command norm, (n_rows, n_commands) -> (n_rows,), that goes with the shells.
        about: what else is known of the robot, as in `CalibratedModel.about`; None: nothing.
        promise: of the blocks of `validation`, for whole poses; None where rows are exchangeable.
        failures: what `train` tells of poses that fail; None: nothing.
    """
    train = model.train
    predicted = np.asarray(model.estimator.predict(validation.inputs))
    known: dict[str, Any] = {
        "calibration": predicted,
        "truth": validation.positions,
        "new": predicted[:0],
        "train_commands": train.commands,
        "calibration_commands": validation.commands,
        "new_commands": validation.commands[:0],
    }
    if method.calibrated_on.has_spread:
        known["train_spread"] = model.spread(train.inputs[rows_with_spread(len(train))])
        known["calibration_spread"] = model.spread(validation.inputs)
        known["new_spread"] = known["calibration_spread"][:0]
    if method.calibrated_on.needs_held_out:
        known["difficulty"] = model.difficulty
    moving = informative_coordinates(train.positions)
    residuals = train.positions - model.estimator.predict(train.inputs)
    scale = error_scale(np.abs(residuals[:, moving]))
    joint = joint_region(residuals, validation.positions - predicted, moving, shells, promise)
    data = method.calibrated_on(**known)
    return CalibratedModel(
        model.dataset,
        model.spec,
        model.preset,
        method,
        model.estimator,
        train,
        data,
        scale,
        joint,
        shells,
        norm,
        failures=failures,
        about=about or {},
    )
