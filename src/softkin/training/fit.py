"""Fit a point model on `train` of a table; write the fitted model and a record of the fit."""

from __future__ import annotations

import logging
from pathlib import Path

import joblib

from softkin.core.files import replacing, write_json
from softkin.core.job import stopwatch
from softkin.core.samples import TRAIN
from softkin.data.table import read_subset
from softkin.models.spec import ModelSpec
from softkin.training.kinematic_model import FitSettings, fit_quietly, kinematic_model, some_rows

logger = logging.getLogger("softkin")


def fit(
    table: str | Path,
    *,
    spec: ModelSpec,
    settings: FitSettings,
    model: str | Path,
    record: str | Path,
    max_rows: int | None = None,
) -> None:
    """Fit on `train` of `table`; write the fitted `model` and a `record` of its settings and times.

    Parameters:
        table: path of the tidy table (Parquet).
        spec: the model.
        settings: its parameters, target space, seed and threads.
        model: path of the fitted model (joblib).
        record: path of the record (JSON).
        max_rows: rows at most, for a model that cannot take more: the others are left out at random, and the log says
            so.
    """
    samples = some_rows(read_subset(table, TRAIN), max_rows, settings.seed)
    estimator = kinematic_model(spec, settings)
    with stopwatch() as watch:
        stopped = fit_quietly(estimator, samples, settings.threads)
    with replacing(model) as temporary:
        joblib.dump(estimator, temporary, compress=3)
    write_json(
        record,
        {
            "params": settings.params,
            "skip_constant": settings.skip_constant,
            "target_space": settings.target_space,
            "base": settings.base,
            "n_train": len(samples),
            "solvers_at_iteration_bound": stopped,
            "fit_seconds": watch.seconds,
            "fit_cpu_seconds": watch.cpu_seconds,
        },
    )
    logger.info("fitted on %d rows in %.1f s", len(samples), watch.seconds)
