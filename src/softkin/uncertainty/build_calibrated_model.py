"""Build the calibrated model that a choice deploys, as one file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import joblib

from softkin.core.errors import ConfigError
from softkin.core.files import read_json, replacing
from softkin.core.job_records import load_model
from softkin.core.runs import Run
from softkin.data.table import content_hash
from softkin.models.spec import PointModel
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.choose import deployed_choice
from softkin.uncertainty.failures import failure_class
from softkin.uncertainty.intervals.spec import AUTO, IntervalMethod
from softkin.uncertainty.orientation_model import ORIENTATION
from softkin.uncertainty.promise import promised
from softkin.uncertainty.stored_outputs import StoredOutputs, norm_of, shells_of


def build_calibrated_model(
    outputs: StoredOutputs,
    *,
    description: str | Path,
    choice: str | Path,
    specs: Mapping[str, PointModel],
    methods: Mapping[str, IntervalMethod[Any]],
    models: Mapping[Run, str | Path],
    orientation: str | Path | None = None,
    output: str | Path,
) -> None:
    """Write the calibrated model that a `choice` deploys.

    Parameters:
        outputs: stored outputs of the dataset.
        description: of the dataset: its name, and those of the robot's own columns where they are known, and a unit
            that is not mm.
        choice: the candidates of `choose` (CSV).
        specs: entries of the registry by model.
        methods: interval methods by name.
        models: run -> file of the fitted estimator (joblib).
        orientation: the model of the tip's orientation (joblib); None where there is none.
        output: the calibrated model (joblib).

    Raises:
        ConfigError: no configured method puts an interval around a model.
    """
    written = read_json(description)
    dataset = written["dataset"]
    best = deployed_choice(choice)
    if best is None:
        raise ConfigError(
            "no configured method puts an interval around a model",
            where=dataset,
            fix="add scp_mapie to interval_methods",
        )
    run, train = Run(best["model"], best["preset"]), outputs.train
    extrapolation: dict[str, Any] = {}
    if best["outside"] == AUTO:
        extrapolation = {"shells": shells_of(outputs.shells, train)[run], "norm": norm_of(outputs.shells)}
    about = {"data": content_hash(train)} | {key: written[key] for key in ("columns", "unit") if key in written}
    about |= {} if orientation is None else {ORIENTATION: load_model(orientation)}
    estimator = load_model(models[run])
    robot = calibrated(
        FittedModel(dataset, specs[run.model], run.preset, estimator, train, outputs.difficulties.get(run)),
        promised(methods[best["interval_method"]], outputs.promise),
        outputs.validation,
        **extrapolation,
        about=about,
        promise=outputs.promise,
        failures=failure_class(train),
    )
    with replacing(output) as temporary:
        joblib.dump(robot, temporary, compress=3)
