"""Build the calibrated model of the tip's orientation: choose and fit it on `train`, calibrate it on `validation`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from softkin.core.rotations import angles
from softkin.core.samples import TRAIN, VALIDATION
from softkin.data.table import read_subset
from softkin.training.orientation import fit_orientation
from softkin.uncertainty.orientation_model import ORIENTATION, OrientationModel
from softkin.uncertainty.promise import calibration_set


def orientation_model(
    table: str | Path, description: Mapping[str, Any], *, seed: int, threads: int
) -> OrientationModel:
    """The model of a dataset with an orientation, chosen and fitted on `train` and calibrated on `validation`.

    Parameters:
        table: its tidy table (Parquet).
        description: of the dataset, with the mean rotation of `train`.
        seed: everything random follows from it.
        threads: that a fit may use.
    """
    fitted = fit_orientation(read_subset(table, TRAIN), seed=seed, threads=threads)
    rows, _, promise = calibration_set(read_subset(table, VALIDATION))
    scores = angles(np.asarray(fitted.estimator.predict(rows.inputs)), np.asarray(rows.orientation))
    mean = np.array(description[ORIENTATION]["mean_vector"])
    params, missed = fitted.settings.params, fitted.held_out_angles
    return OrientationModel(fitted.name, params, fitted.estimator, mean, scores, promise, missed)
