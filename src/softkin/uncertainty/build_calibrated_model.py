"""Build the calibrated model that a choice deploys, as one file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import joblib

from softkin.core.errors import ConfigError
from softkin.core.files import read_json, replacing
from softkin.core.job_records import load_model
from softkin.core.run_archive import read_run_archive
from softkin.core.runs import Run
from softkin.core.samples import TRAIN, VALIDATION
from softkin.data.table import content_hash, read_subset
from softkin.models.spec import PointModel
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.choose import deployed_choice
from softkin.uncertainty.failures import failure_class
from softkin.uncertainty.intervals.spec import AUTO, IntervalMethod
from softkin.uncertainty.promise import calibration_set, promised
from softkin.uncertainty.stored_outputs import norm_of, shells_of


def build_calibrated_model(
    table: str | Path,
    *,
    description: str | Path,
    choice: str | Path,
    specs: Mapping[str, PointModel],
    methods: Mapping[str, IntervalMethod[Any]],
    models: Mapping[Run, str | Path],
    shells: str | Path | None,
    output: str | Path,
) -> None:
    """Write the calibrated model that a `choice` deploys.

    Parameters:
        table: the tidy table, of which `train` and `validation` are read.
        description: of the dataset: its name, and those of the robot's own columns where they are known, and a unit
            that is not mm.
        choice: the candidates of `choose` (CSV).
        specs: entries of the registry by model.
        methods: interval methods by name.
        models: run -> file of the fitted estimator (joblib).
        shells: the file of the rule `refit_shells`, if there is one.
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
    run, train = Run(best["model"], best["preset"]), read_subset(table, TRAIN)
    extrapolation: dict[str, Any] = {}
    if best["outside"] == AUTO:
        archive = read_run_archive(shells)
        extrapolation = {"shells": shells_of(archive, train)[run], "norm": norm_of(archive)}
    about = {"data": content_hash(train)} | {key: written[key] for key in ("columns", "unit") if key in written}
    validation, _, promise = calibration_set(read_subset(table, VALIDATION))
    robot = calibrated(
        FittedModel(dataset, specs[run.model], run.preset, load_model(models[run]), train),
        promised(methods[best["interval_method"]], promise),
        validation,
        **extrapolation,
        about=about,
        promise=promise,
        failures=failure_class(train),
    )
    with replacing(output) as temporary:
        joblib.dump(robot, temporary, compress=3)
