"""A calibrated model that takes a tenth of a second to make: a polynomial of two commands, one marker."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from softkin.core.shells import command_norm
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.calibration_data import Shell
from softkin.uncertainty.intervals import INTERVAL_METHODS
from tests.conftest import bending_arm

#: As the robot's own file names them, in cm.
COLUMNS: dict[str, Any] = {
    "commands": ["left", "right"],
    "positions": ["tip x", "tip y", "tip z"],
    "mm_per_unit": 10.0,
    "dimensions": 3,
}
SETTINGS = FitSettings({"degree": 3, "alpha": 1e-3}, skip_constant=True, seed=0, threads=1)


@cache
def small_robot(method: str = "scp_crepes", shells: bool = False, named: bool = True) -> CalibratedModel:
    """The robot, with shells of `train` at half and at 70 % of its rows."""
    train = bending_arm(120, seed=0)
    spec = MODELS["ridge"]
    norm = command_norm(train.commands, standardised=False).of
    found, norms = [], norm(train.commands)
    for share in (0.5, 0.7) if shells else ():
        core = norms <= np.quantile(norms, share)
        predicted = fitted_model(spec, SETTINGS, train.take(core)).predict(train.commands[~core])
        found.append(Shell(train.commands[core], train.commands[~core], predicted, train.positions[~core]))
    about: dict[str, Any] = {"data": "ab" * 32, "columns": COLUMNS} if named else {}
    model = FittedModel("arm", spec, "tuned", fitted_model(spec, SETTINGS, train), train)
    validation = bending_arm(60, seed=7)
    return calibrated(model, INTERVAL_METHODS[method], validation, found, norm if shells else None, about)
