"""Tune a quantile regressor on `train`: a study of its pinball loss in grouped cross-validation."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from softkin.core.errors import DataError
from softkin.core.files import replacing, write_json
from softkin.core.folds import Folds, grouped_folds
from softkin.core.metrics.pinball import pinball_losses
from softkin.core.runs import PAPERS_LEVEL
from softkin.core.samples import TRAIN, Array, Params, Samples, informative_coordinates
from softkin.core.threads import limited_threads
from softkin.data.table import read_subset
from softkin.models.quantile.spec import QuantileSpec
from softkin.training.bounded_space import bounded_space
from softkin.training.fit_quantiles import QuantileModel
from softkin.training.study import Search, StudyFile, TuningSettings, bounded_rows, record, run_study

#: Moving coordinates that a study tunes on: each costs a regressor of its own.
MAX_COORDINATES = 2


def some_coordinates(samples: Samples) -> Samples:
    """Samples with at most `MAX_COORDINATES` moving coordinates, evenly spread over the robot.

    Raises:
        DataError: none moves.
    """
    moving = np.flatnonzero(informative_coordinates(samples.positions))
    if not len(moving):
        raise DataError(
            "no coordinate moves, so there is nothing to tune",
            where="`train`",
            fix="check the positions of `train`",
        )
    places = np.unique(np.linspace(0, len(moving) - 1, MAX_COORDINATES).round().astype(int))
    return Samples(samples.commands, samples.positions[:, moving[places]])


def pinball_errors(
    spec: QuantileSpec, params: Params, samples: Samples, folds: Folds, seed: int, threads: int
) -> Iterator[float]:
    """Mean pinball loss (mm) of the pair of quantiles of the paper's level, fold by fold.

    Parameters:
        spec: the quantile regressor.
        params: its parameters.
        samples: rows of `train`.
        folds: of each fold the rows that are fitted on, standardisation included, and those that are scored.
        seed: seed of the fits.
        threads: threads of a fit at most.
    """
    for fitted_rows, scored_rows in folds:
        model = QuantileModel(spec, params, [PAPERS_LEVEL], seed, threads)
        with limited_threads(threads):
            model.fit(Samples(samples.commands[fitted_rows], samples.positions[fitted_rows]))
        quantiles: Array = model.predict(samples.commands[scored_rows])[0]
        alpha = 1 - PAPERS_LEVEL
        losses = [
            pinball_losses(samples.positions[scored_rows], quantiles[..., side], quantile).mean()
            for side, quantile in enumerate((alpha / 2, 1 - alpha / 2))
        ]
        yield float(np.mean(losses))


def tune_quantiles(
    table: str | Path,
    *,
    spec: QuantileSpec,
    settings: TuningSettings,
    file: StudyFile,
    threads: int,
    parameters: str | Path,
    trials: str | Path,
) -> None:
    """Tune a quantile regressor on `train` of `table`; write the best parameters and all trials.

    Parameters:
        table: path of the tidy table (Parquet).
        spec: the quantile regressor.
        settings: number of trials; folds, rows and seed of a trial.
        file: where the study lives, and the code that decides it.
        threads: threads of a fit at most.
        parameters: path of the best parameters (JSON).
        trials: path of all trials (CSV).
    """
    samples = some_coordinates(read_subset(table, TRAIN))
    rows = bounded_rows(samples, settings.max_rows, settings.seed)
    folds = grouped_folds(rows.commands, settings.n_folds, settings.seed)
    result = run_study(
        samples,
        search=Search(
            name=f"quantiles of {spec.name}",
            space=bounded_space(spec, rows.commands.shape[1], folds),
            first_trials=spec.first_trials,
            errors_of=lambda params: pinball_errors(spec, params, rows, folds, settings.seed, threads),
            n_parts=len(folds),
        ),
        settings=settings,
        file=file,
    )
    with replacing(trials) as temporary:
        result.trials.to_csv(temporary, index=False)
    write_json(parameters, {"params": result.params, "cv_pinball_mm": result.score_mm, **record(result)})
