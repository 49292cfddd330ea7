"""Refit models on folds and bootstrap samples of `train`, for CV+ and jackknife+-after-bootstrap."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from softkin.core.clocks import stopwatch
from softkin.core.errors import ConfigError
from softkin.core.failed_parts import MODELS, of_part
from softkin.core.files import read_json
from softkin.core.folds import folds_of
from softkin.core.run_archive import CPU_SECONDS, RunArchive
from softkin.core.runs import Run
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, Array
from softkin.data.table import read_subset
from softkin.models.spec import ModelSpec
from softkin.training.kinematic_model import fitted_model, recorded_settings
from softkin.training.members import Weights, combined

logger = logging.getLogger("softkin")

MAX_DRAWS = 1000
#: Parts of the archive: predictions of the fold models and of the models of bootstrap samples, and their rows.
FOLDS, RESAMPLES = "folds", "resamples"
FOLD_OF_ROW, RESAMPLE_ROWS = "fold_of_row", "resample_rows"


@dataclass(frozen=True, slots=True)
class RefittingSettings:
    """`n_folds` folds (see `folds_of`), `n_resamples` bootstrap samples; a dataset of more than
    `max_train_rows` rows of `train` is left out, and the log names it.
    """

    n_folds: int
    n_resamples: int
    max_train_rows: int
    seed: int


def refit(
    table: str | Path,
    *,
    dataset: str,
    specs: Mapping[Run, ModelSpec],
    records: Mapping[Run, str | Path],
    settings: RefittingSettings,
    threads: int,
    refits: str | Path,
    weights: Mapping[Run, Weights] | None = None,
) -> None:
    """Write what the refits of each run predict of train, test and extrapolation, rows in this order.

    The archive holds, of each run, `folds` (n_folds, n_rows, n_coordinates) and `resamples` (n_resamples, n_rows,
    n_coordinates) in mm, and shared by all runs `fold_of_row` (n_train,), `resample_rows` (n_resamples, n_train) and
    `fit_cpu_seconds`.

    Parameters:
        table: path of the tidy table (Parquet).
        dataset: its name, for the log.
        specs: the model of each run.
        records: path of the fit record (JSON) of each run: a refit has the parameters of the fit.
        settings: folds, bootstrap samples and seed.
        threads: threads of a fit at most.
        refits: path of the archive (`RunArchive`).
        weights: the runs that are written, each the weighted mean of these `specs`; None: all of `specs`.
    """
    train = read_subset(table, TRAIN)
    everywhere = np.concatenate([read_subset(table, subset).inputs for subset in (TRAIN, TEST, EXTRAPOLATION)])
    if len(train) > settings.max_train_rows:
        logger.info(
            "%s is left out of the methods that refit: %d rows of train, refitting.max_train_rows is %d",
            dataset,
            len(train),
            settings.max_train_rows,
        )
        RunArchive({CPU_SECONDS: np.array(0.0)}).write(refits)
        return
    folds = folds_of(train, settings.n_folds, settings.seed)
    resamples = drawn_resamples(len(train), settings)
    fold_of_row = np.empty(len(train), dtype=np.intp)
    for fold, (_, held_out) in enumerate(folds):
        fold_of_row[held_out] = fold
    parts = {FOLDS: [fitted for fitted, _ in folds], RESAMPLES: resamples}
    predictions: dict[tuple[Run, str], Array] = {}
    cpu_seconds = 0.0
    for place, (run, spec) in enumerate(specs.items()):
        fit_settings = recorded_settings(read_json(records[run]), settings.seed, threads)
        for part, fits in parts.items():
            predicted = []
            for rows in fits:
                with of_part(MODELS, run.model), stopwatch() as watch:
                    model = fitted_model(spec, fit_settings, train.take(rows))
                cpu_seconds += watch.cpu_seconds
                predicted.append(model.predict(everywhere))
            predictions[run, part] = np.stack(predicted)
        logger.info("%d of %d models refitted: %s", place + 1, len(specs), " ".join(run))
    shared = {FOLD_OF_ROW: fold_of_row, RESAMPLE_ROWS: np.stack(resamples), CPU_SECONDS: np.array(cpu_seconds)}
    RunArchive(shared, predictions if weights is None else combined(predictions, weights)).write(refits)


def drawn_resamples(n_rows: int, settings: RefittingSettings) -> list[NDArray[np.intp]]:
    """Bootstrap samples (row numbers) such that each row is left out of at least one, whose refit then predicts it.

    Raises:
        ConfigError: too few samples for so many rows.
    """
    rng = np.random.default_rng(settings.seed)
    for _ in range(MAX_DRAWS):
        drawn = rng.integers(n_rows, size=(settings.n_resamples, n_rows))
        kept = np.zeros((settings.n_resamples, n_rows), dtype=bool)
        np.put_along_axis(kept, drawn, True, axis=1)
        if not kept.all(axis=0).any():
            return list(drawn)
    raise ConfigError(
        f"some of {n_rows} rows stand in all {settings.n_resamples} bootstrap samples, in each of {MAX_DRAWS} draws",
        where="refitting.n_resamples",
        fix="raise refitting.n_resamples",
    )
