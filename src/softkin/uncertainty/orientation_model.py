"""The calibrated model of the tip's orientation: a rotation at any command, and a bound on the angle that it is off.

Split conformal prediction (Vovk et al. 2005) with the angle between the predicted and the measured rotation as the
nonconformity score: a ball of rotations around the predicted one, of one size everywhere.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from softkin.core.rotations import angles, from_mean
from softkin.core.samples import Array, Samples
from softkin.uncertainty.conformal import conformal_limit
from softkin.uncertainty.intervals.spec import MARGINAL
from softkin.uncertainty.promise import Promise, asked_levels

#: Key of `CalibratedModel.about` for it.
ORIENTATION = "orientation"


@dataclass(frozen=True, slots=True)
class OrientationModel:
    """A fitted model of rotation vectors about the `mean` (3,) of `train`; the angles `scores` (n_calibration,) in
    degrees by which it misses the calibration set, and `missed` (n_rows,), those of held-out folds of `train`.
    """

    model: str
    params: Mapping[str, Any]
    estimator: Any
    mean: Array
    scores: Array
    promise: Promise | None
    missed: Array

    def vectors(self, inputs: Array) -> Array:
        """Predicted rotation vectors (n_rows, 3) in rad, about no mean, of a model's inputs (n_rows, n_inputs)."""
        return from_mean(np.asarray(self.estimator.predict(inputs)), self.mean)

    def angles(self, rows: Samples) -> Array:
        """Angles (n_rows,) in degrees between predicted and measured rotations."""
        return angles(np.asarray(self.estimator.predict(rows.inputs)), np.asarray(rows.orientation))

    def bound(self, confidence_level: float) -> float:
        """The angle in degrees that holds a new error at the level; infinite where the calibration set is too small."""
        (level,) = asked_levels(self.promise, [confidence_level])
        return conformal_limit(self.scores, level)

    def guarantee(self, confidence_level: float) -> str:
        """What the bound promises in-domain."""
        return MARGINAL if self.promise is None else self.promise.of_region(MARGINAL, confidence_level)
