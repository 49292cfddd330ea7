"""Fit a point model on `train` of a table; write the fitted model, its predictions and a record of both."""

from __future__ import annotations

import logging
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import joblib

from softkin.core.clocks import stopwatch
from softkin.core.files import replacing, write_json
from softkin.core.samples import TRAIN
from softkin.data.table import read_subset
from softkin.models.spec import ModelSpec
from softkin.training.bounded_rows import some_rows
from softkin.training.kinematic_model import FitSettings, fit_quietly, kinematic_model
from softkin.training.predict import predict

logger = logging.getLogger("softkin")


@dataclass(frozen=True, slots=True)
class FitFiles:
    """Files of one fit: the `model` (joblib), a `record` of settings and times (JSON), the `predictions` (Parquet)."""

    model: str | Path
    record: str | Path
    predictions: str | Path


def fit_each(
    table: str | Path,
    *,
    spec: ModelSpec,
    fits: Sequence[tuple[FitSettings, FitFiles]],
    max_rows: int | None = None,
) -> None:
    """Fit by each of several settings, as `fit` does. What two studies found alike is fitted once: a fit follows from
    its settings to the bit, and the second takes copies of the first one's files, times included.

    Parameters:
        table: path of the tidy table (Parquet).
        spec: the model.
        fits: settings, and where model, record and predictions go.
        max_rows: as of `fit`.
    """
    done: list[tuple[FitSettings, FitFiles]] = []
    for settings, files in fits:
        same = next((known for made, known in done if made == settings), None)
        if same is None:
            fit(table, spec=spec, settings=settings, files=files, max_rows=max_rows)
            done.append((settings, files))
            continue
        pairs = ((same.model, files.model), (same.record, files.record), (same.predictions, files.predictions))
        for source, target in pairs:
            with replacing(target) as temporary:
                shutil.copyfile(source, temporary)
        logger.info("its settings are those of a fit before, whose model and predictions are taken")


def fit(
    table: str | Path, *, spec: ModelSpec, settings: FitSettings, files: FitFiles, max_rows: int | None = None
) -> None:
    """Fit on `train` of `table` and predict every subset; write the fitted model, its predictions and a record.

    Parameters:
        table: path of the tidy table (Parquet).
        spec: the model.
        settings: its parameters, target space, seed and threads.
        files: where model, record and predictions (see `predict`) go.
        max_rows: rows at most, for a model that cannot take more: the others are left out at random, and the log says
            so.
    """
    samples = some_rows(read_subset(table, TRAIN), max_rows, settings.seed)
    estimator = kinematic_model(spec, settings, samples.recording)
    with stopwatch() as watch:
        stopped = fit_quietly(estimator, samples, settings.threads)
    with replacing(files.model) as temporary:
        joblib.dump(estimator, temporary, compress=3)
    microseconds = predict(
        table, spec=spec, estimator=estimator, threads=settings.threads, predictions=files.predictions
    )
    write_json(
        files.record,
        {
            "params": settings.params,
            "skip_constant": settings.skip_constant,
            "target_space": settings.target_space,
            "base": settings.base,
            "memory": settings.memory,
            "n_train": len(samples),
            "solvers_at_iteration_bound": stopped,
            "fit_seconds": watch.seconds,
            "fit_cpu_seconds": watch.cpu_seconds,
            "predict_us_per_row": microseconds,
        },
    )
    logger.info("fitted on %d rows in %.1f s", len(samples), watch.seconds)
