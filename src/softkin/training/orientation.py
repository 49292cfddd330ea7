"""Fit a model of the tip's orientation, chosen on `train` alone: commands -> rotation vector about its mean."""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from softkin.core.folds import folds_of
from softkin.core.rotations import angles
from softkin.core.samples import Array, Samples
from softkin.models.estimators.memory_features import NONE, PLAY
from softkin.models.of_orientation import CANDIDATES
from softkin.models.spec import ModelSpec
from softkin.training.bounded_rows import some_rows
from softkin.training.kinematic_model import FitSettings, fitted_model

logger = logging.getLogger("softkin")

N_FOLDS = 5
#: Rows of `train` at most on which candidates are compared, and on which the chosen one is fitted.
COMPARED_ROWS, FITTED_ROWS = 1500, 6000
#: What a candidate may be told of the commands before, on a recording; sessions have zeros in any case.
MEMORIES = ({"memory": NONE, "zeros": True}, {"memory": PLAY, "widths": "fine", "zeros": True})


@dataclass(frozen=True, slots=True)
class FittedOrientation:
    """The chosen model, and by how much (degrees) it missed each row (n_rows,) that was held out of its folds."""

    name: str
    settings: FitSettings
    estimator: Any
    held_out_angles: Array


def fit_orientation(train: Samples, *, seed: int, threads: int) -> FittedOrientation:
    """The candidate of the least mean angle over held-out folds of `train`, fitted on all its rows.

    Parameters:
        train: rows with their orientation (n_rows, 3) in rad.
        seed: folds, and rows that are drawn, follow from it.
        threads: that a fit may use.
    """
    turned = replace(train, positions=np.asarray(train.orientation))
    rows = some_rows(turned, COMPARED_ROWS, seed)
    memories = (None,) if train.recording is None else MEMORIES
    compared = []
    for spec, params in CANDIDATES:
        for memory in memories:
            settings = FitSettings(params, True, seed, threads, memory=memory)
            compared.append((spec, settings, held_out_angles(spec, settings, rows)))
    spec, settings, missed = min(compared, key=lambda candidate: float(candidate[2].mean()))
    logger.info("orientation: %s %s, %.3g degrees on held-out folds", spec.name, settings.params, missed.mean())
    estimator = fitted_model(spec, settings, some_rows(turned, FITTED_ROWS, seed))
    return FittedOrientation(spec.name, settings, estimator, missed)


def held_out_angles(spec: ModelSpec, settings: FitSettings, rows: Samples) -> Array:
    """Angles (n_rows,) in degrees between each orientation and what a model says that was fitted without its fold;
    `rows` have rotation vectors as positions.
    """
    missed = np.empty(len(rows))
    for fitted, held_out in folds_of(rows, N_FOLDS, settings.seed):
        estimator = fitted_model(spec, settings, rows.take(fitted))
        missed[held_out] = angles(np.asarray(estimator.predict(rows.inputs[held_out])), rows.positions[held_out])
    return missed
