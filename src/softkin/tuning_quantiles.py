"""Tune a learner of quantiles on one dataset: pinball loss in grouped cross-validation on `train`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from softkin.datasets.table import read_subset
from softkin.files import replacing, write_json
from softkin.folds import Folds, grouped_folds
from softkin.interface import (
    PAPERS_LEVEL,
    TRAIN,
    Array,
    Params,
    QuantileSpec,
    Samples,
    SoftkinError,
    informative_coordinates,
)
from softkin.metrics.pinball import pinball_losses
from softkin.quantiles import QuantileModel
from softkin.tuning import TuningSettings, bounded_rows, record, tune

#: A study sees this many moving coordinates, evenly spread over the robot: each costs a model of its own.
MAX_COORDINATES = 2


def some_coordinates(samples: Samples) -> Samples:
    """At most `MAX_COORDINATES` moving coordinates, evenly spread.

    Raises:
        SoftkinError: none moves.
    """
    moving = np.flatnonzero(informative_coordinates(samples.positions))
    if not len(moving):
        raise SoftkinError("no coordinate moves on `train`: there is nothing to tune; mend: check the positions")
    places = np.unique(np.linspace(0, len(moving) - 1, MAX_COORDINATES).round().astype(int))
    return Samples(samples.commands, samples.positions[:, moving[places]])


def pinball_errors(
    spec: QuantileSpec, params: Params, samples: Samples, folds: Folds, seed: int, threads: int
) -> Iterator[float]:
    """Mean pinball loss (mm) of the pair of quantiles of the paper's level, fold by fold, all fitted inside it."""
    for inside, outside in folds:
        model = QuantileModel(spec, params, [PAPERS_LEVEL], seed, threads)
        with threadpool_limits(threads):
            model.fit(Samples(samples.commands[inside], samples.positions[inside]))
        quantiles: Array = model.predict(samples.commands[outside])[0]
        alpha = 1 - PAPERS_LEVEL
        losses = [
            pinball_losses(samples.positions[outside], quantiles[..., side], quantile).mean()
            for side, quantile in enumerate((alpha / 2, 1 - alpha / 2))
        ]
        yield float(np.mean(losses))


def tune_quantiles(
    table: str | Path,
    *,
    spec: QuantileSpec,
    settings: TuningSettings,
    study_file: str | Path,
    code: Sequence[str | Path],
    threads: int,
    parameters: str | Path,
    trials: str | Path,
) -> None:
    """Tune on the rows of `train` in `table`; write the best `parameters` (JSON) and all `trials` (CSV)."""
    samples = some_coordinates(read_subset(table, TRAIN))
    rows = bounded_rows(samples, settings.max_rows, settings.seed)
    folds = grouped_folds(rows.commands, settings.n_folds, settings.seed)
    result = tune(
        samples,
        name=f"quantiles of {spec.name}",
        search_space=spec.search_space,
        first_trials=spec.first_trials,
        errors_of=lambda params: pinball_errors(spec, params, rows, folds, settings.seed, threads),
        n_parts=len(folds),
        settings=settings,
        study_file=study_file,
        code=code,
    )
    with replacing(trials) as temporary:
        result.trials.to_csv(temporary, index=False)
    write_json(parameters, {"params": result.params, "cv_pinball_mm": result.score_mm, **record(result)})
