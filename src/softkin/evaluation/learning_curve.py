"""Learning curves: errors on `test` of models fitted to a part of `train`, with the parameters of their runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.csv_tables import write_csv
from softkin.core.failed_parts import MODELS, of_part
from softkin.core.metrics.point import paper_metrics
from softkin.core.rows import sampled_rows
from softkin.core.runs import Run
from softkin.core.samples import TEST, TRAIN, Samples, coordinate_columns
from softkin.data.table import read_subset
from softkin.models.spec import ModelSpec
from softkin.training.kinematic_model import FitSettings, fitted_model

#: Shares of `train`, and how many parts of that size are drawn; the run itself was fitted to all of it.
DRAWS = {0.05: 1, 0.1: 2, 0.25: 1}
ERRORS = ["rmse_mm", "mae_mm"]
COLUMNS = ["dataset", "subset", "model", "preset", "share", "n_rows", "n_draws", *ERRORS]


@dataclass(frozen=True, slots=True)
class FittedRun:
    """A run of a model: its `spec`, the `settings` of its fit, and the file of its predictions."""

    spec: ModelSpec
    settings: FitSettings
    predictions: str | Path


def learning_curve(table: str | Path, *, dataset: str, runs: Mapping[Run, FittedRun], output: str | Path) -> None:
    """Write errors on `test` (CSV, `COLUMNS`), a row per run and share of `train`, means over draws.

    Parts are drawn at random with the seed of the fit, the same for all runs; at a share of 1 the stored predictions of
    the run are scored.

    Parameters:
        table: path of the tidy table.
        dataset: its name.
        runs: what is fitted.
        output: path of the scores.
    """
    train, test = read_subset(table, TRAIN), read_subset(table, TEST)
    rows = []
    for run, fitted in runs.items():
        key: dict[str, Any] = {"dataset": dataset, "subset": TEST, "model": run.model, "preset": run.preset}
        with of_part(MODELS, run.model):
            rows += [key | row for row in _of_parts(fitted, train, test)]
        columns = coordinate_columns(test.positions.shape[1] // 3)
        stored = pd.read_parquet(fitted.predictions)
        predicted = np.asarray(stored.loc[stored["subset"] == TEST, columns], dtype=np.float64)
        scores = paper_metrics(test.positions, predicted)
        rows.append(key | {"share": 1.0, "n_rows": len(train), "n_draws": 1} | {name: scores[name] for name in ERRORS})
    write_csv(output, pd.DataFrame(rows, columns=COLUMNS))


def _of_parts(fitted: FittedRun, train: Samples, test: Samples) -> Iterator[dict[str, Any]]:
    for share, n_draws in DRAWS.items():
        n_rows, errors = max(2, round(share * len(train))), []
        for draw in range(n_draws):
            part = train.take(sampled_rows(len(train), n_rows, fitted.settings.seed + draw))
            predicted = fitted_model(fitted.spec, fitted.settings, part).predict(test.inputs)
            errors.append(paper_metrics(test.positions, predicted))
        means = {name: np.mean([of[name] for of in errors]) for name in ERRORS}
        yield {"share": share, "n_rows": n_rows, "n_draws": n_draws} | means
