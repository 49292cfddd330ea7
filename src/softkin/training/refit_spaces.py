"""Fit every model in the target space that its study has not chosen, to compare target spaces model by model."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from softkin.core.errors import SoftkinError
from softkin.core.failed_parts import MODELS, of_part
from softkin.core.files import read_json, replacing
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, Params, coordinate_columns
from softkin.data.table import read_subset
from softkin.models.spec import ModelSpec
from softkin.training.bounded_rows import some_rows
from softkin.training.kinematic_model import fitted_model, recorded_settings

logger = logging.getLogger("softkin")

SPACE_SUBSETS = (TEST, EXTRAPOLATION)


def refit_spaces(
    table: str | Path,
    *,
    specs: Mapping[str, ModelSpec],
    parameters: Mapping[str, str | Path],
    base: Params | None,
    max_fit_rows: Mapping[str, int],
    seed: int,
    threads: int,
    predictions: str | Path,
) -> None:
    """Write what each model, fitted in the other target space, predicts of test and extrapolation.

    Of test and extrapolation commands are read and no positions.

    Parameters:
        table: path of the tidy table (Parquet).
        specs: the models by name.
        parameters: path of the best parameters (JSON) of the preset `outer`, by model.
        base: the robot's base as the dataset's entry declares it.
        max_fit_rows: rows of a fit at most, by model; a model that is missing takes any number.
        seed: seed of the fits, and of the draw of rows.
        threads: threads of a fit at most.
        predictions: path of the predictions (Parquet: model, target_space, subset, m1_x.. in mm).
    """
    train = read_subset(table, TRAIN)
    inputs = {subset: read_subset(table, subset).inputs for subset in SPACE_SUBSETS}
    columns = coordinate_columns(train.positions.shape[1] // 3)
    frames = [pd.DataFrame(columns=["model", "target_space", "subset", *columns])]
    for place, (model, spec) in enumerate(specs.items()):
        other = read_json(parameters[model])["other_space"]
        if other is None:
            logger.info("%s is left out: no trial of another target space was scored", model)
            continue
        record = {"skip_constant": True, "base": base, **other}
        try:
            samples = some_rows(train, max_fit_rows.get(model), seed)
            estimator = fitted_model(spec, recorded_settings(record, seed, threads), samples)
        except SoftkinError as error:
            logger.warning("%s is left out in %s: %s", model, other["target_space"], error)
            continue
        for subset, rows in inputs.items():
            with of_part(MODELS, model):
                frame = pd.DataFrame(np.asarray(estimator.predict(rows)), columns=columns)
            frames.append(frame.assign(model=model, target_space=other["target_space"], subset=subset))
        logger.info("%d of %d models fitted: %s in %s", place + 1, len(specs), model, other["target_space"])
    with replacing(predictions) as temporary:
        pd.concat(frames, ignore_index=True).to_parquet(temporary, index=False)
