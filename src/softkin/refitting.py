"""Fit a model again and again on parts of `train`: what CV+ and jackknife+-after-bootstrap start from."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.datasets.table import read_subset
from softkin.files import read_json, replacing
from softkin.fitting import fit_quietly, kinematic_model
from softkin.folds import grouped_folds
from softkin.interface import EXTRAPOLATION, TEST, TRAIN, Array, ModelSpec, Samples, SoftkinError
from softkin.job import stopwatch

logger = logging.getLogger("softkin")

MAX_DRAWS = 1000


@dataclass(frozen=True, slots=True)
class RefittingSettings:
    """`n_folds` folds grouped by distinct command, `n_resamples` bootstrap samples; datasets of more than
    `max_train_rows` rows of train are left out, by name, in the log.
    """

    n_folds: int
    n_resamples: int
    max_train_rows: int
    seed: int


def refit(
    table: str | Path,
    *,
    dataset: str,
    specs: Mapping[tuple[str, str], ModelSpec],
    records: Mapping[tuple[str, str], str | Path],
    settings: RefittingSettings,
    threads: int,
    refits: str | Path,
) -> None:
    """Write `refits` (NumPy archive), in mm, with rows of train, test and extrapolation, in this order:

    `{model}/{preset}/folds` (n_folds, n_rows, n_coordinates), `{model}/{preset}/resamples` (n_resamples, n_rows,
    n_coordinates), and of all runs `fold_of_row` (n_train,), `resample_rows` (n_resamples, n_train) and
    `fit_cpu_seconds`.

    `records` are the runs' fit records: each is refitted with the parameters it was fitted with.
    """
    train = read_subset(table, TRAIN)
    everywhere = np.concatenate([read_subset(table, subset).commands for subset in (TRAIN, TEST, EXTRAPOLATION)])
    arrays: dict[str, Array | NDArray[np.intp]] = {}
    if len(train) > settings.max_train_rows:
        logger.info(
            "%s is left out of the methods that refit: %d rows of train, refitting.max_train_rows is %d",
            dataset,
            len(train),
            settings.max_train_rows,
        )
        specs = {}
    else:
        folds = grouped_folds(train.commands, settings.n_folds, settings.seed)
        resamples = drawn_resamples(len(train), settings)
        arrays["fold_of_row"] = np.empty(len(train), dtype=np.intp)
        for place, (_, outside) in enumerate(folds):
            arrays["fold_of_row"][outside] = place
        arrays["resample_rows"] = np.stack(resamples)
    cpu_seconds = 0.0
    for place, (run, spec) in enumerate(specs.items()):
        record = read_json(records[run])
        for kind, rows in (("folds", [inside for inside, _ in folds]), ("resamples", resamples)):
            predicted = []
            for inside in rows:
                samples = Samples(train.commands[inside], train.positions[inside])
                with stopwatch() as watch:
                    estimator = refitted(spec, record, samples, seed=settings.seed, threads=threads)
                cpu_seconds += watch.cpu_seconds
                predicted.append(estimator.predict(everywhere))
            arrays["/".join((*run, kind))] = np.stack(predicted)
        logger.info("%d of %d models refitted: %s", place + 1, len(specs), " ".join(run))
    arrays["fit_cpu_seconds"] = np.array(cpu_seconds)
    with replacing(refits) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, **arrays)  # type: ignore[arg-type]


def refitted(spec: ModelSpec, record: Mapping[str, Any], samples: Samples, *, seed: int, threads: int) -> Any:
    """The model of a fit `record`, fitted on other samples with the same parameters."""
    estimator = kinematic_model(
        spec,
        record["params"],
        skip_constant=record["skip_constant"],
        seed=seed,
        threads=threads,
        target_space=record["target_space"],
        base=record["base"],
    )
    fit_quietly(estimator, samples, threads)
    return estimator


def drawn_resamples(n_rows: int, settings: RefittingSettings) -> list[NDArray[np.intp]]:
    """Bootstrap samples (row numbers) such that each row is left out of at least one: else nothing could judge it.

    Raises:
        SoftkinError: too few samples for so many rows.
    """
    rng = np.random.default_rng(settings.seed)
    for _ in range(MAX_DRAWS):
        drawn = rng.integers(n_rows, size=(settings.n_resamples, n_rows))
        kept = np.zeros((settings.n_resamples, n_rows), dtype=bool)
        np.put_along_axis(kept, drawn, True, axis=1)
        if not kept.all(axis=0).any():
            return list(drawn)
    raise SoftkinError(
        f"of {n_rows} rows some stand in all {settings.n_resamples} bootstrap samples, however they are drawn; "
        "mend: raise refitting.n_resamples"
    )
