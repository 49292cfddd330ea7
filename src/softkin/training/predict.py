"""Predict the positions of every subset, and the spread, with a fitted model."""

from __future__ import annotations

import re
import statistics
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.files import replacing
from softkin.core.rows import Indices, sampled_rows
from softkin.core.samples import SUBSETS, TEST, TRAIN, Array, Samples, coordinate_columns
from softkin.core.threads import limited_threads
from softkin.data.table import read_subset
from softkin.models.spec import PointModel

#: Prefixes of the columns of a model's spread: of a predictive standard deviation, and of any other.
STANDARD_DEVIATION, SPREAD = "std_", "spread_"
#: Rows of `train` at most that have a spread: intervals need the mean over them, and a row costs a Gaussian process the
#: square of its rows.
SPREAD_ROWS = 4_000
#: Rows at most that predicting is timed on.
TIMED_ROWS = 1_000


def rows_with_spread(n_train: int) -> Indices:
    """Ascending numbers of the rows of `train` whose spread is computed: all, or `SPREAD_ROWS` of them."""
    return sampled_rows(n_train, SPREAD_ROWS, seed=0)


def spread_of(spec: PointModel, estimator: Any, train: Samples, inputs: Array) -> Array:
    """Spread (n_rows, n_coordinates) in mm of a fitted kinematic model at `inputs`."""
    assert spec.spread is not None
    model, known, added = estimator.resolved(train.inputs)
    features = estimator.resolved(inputs)[1]
    scaler, regressor = model.regressor_[0], model.regressor_[-1]
    standardised = Samples(scaler.transform(known), model.transformer_.transform(train.positions - added))
    spread = spec.spread(regressor, standardised, scaler.transform(features))
    return np.asarray(model.transformer_.inverse_spread(model.targets(features), spread))


def predict(
    table: str | Path,
    *,
    spec: PointModel,
    estimator: Any,
    threads: int,
    predictions: str | Path,
    known: Mapping[str, Array] | None = None,
) -> float:
    """Write the predictions of every subset; return how many microseconds a row of `test` takes (median of five
    repetitions on at most `TIMED_ROWS` rows).

    Parameters:
        table: path of the tidy table (Parquet).
        spec: the model.
        estimator: the fitted kinematic model.
        threads: threads at most.
        predictions: path of the predictions (Parquet: subset, m1_x.. in mm, rows as in `table`). A model with a spread
            has columns for it too, in mm: std_m1_x.. where it is a predictive standard deviation, else spread_m1_x...
            Of more than `SPREAD_ROWS` rows of `train` the others have none.
        known: subset -> positions (n_rows, n_coordinates) in mm that it predicts, where they are known.
    """
    train = read_subset(table, TRAIN)
    frames = []
    with limited_threads(threads):
        for subset in SUBSETS:
            inputs = (train if subset == TRAIN else read_subset(table, subset)).inputs
            predicted = estimator.predict(inputs) if known is None else known[subset]
            frames.append(_frame(subset, np.asarray(predicted)))
            if spec.spread is not None:
                rows = rows_with_spread(len(inputs)) if subset == TRAIN else np.arange(len(inputs))
                values = np.full((len(inputs), train.positions.shape[1]), np.nan)
                values[rows] = spread_of(spec, estimator, train, inputs[rows])
                spread = _frame(subset, values)
                prefix = STANDARD_DEVIATION if spec.is_predictive else SPREAD
                frames[-1] = pd.concat([frames[-1], spread.iloc[:, 1:].add_prefix(prefix)], axis=1)
            if subset == TEST:
                microseconds = _microseconds_per_row(estimator, inputs[:TIMED_ROWS])
    with replacing(predictions) as temporary:
        pd.concat(frames, ignore_index=True).to_parquet(temporary, index=False)
    return microseconds


def _frame(subset: str, positions: Array) -> pd.DataFrame:
    columns: Sequence[str] = coordinate_columns(positions.shape[1] // 3)
    frame = pd.DataFrame(positions, columns=columns)
    frame.insert(0, "subset", subset)
    return frame


def predicted_rows(stored: pd.DataFrame, subsets: Sequence[str], prefix: str = "") -> Array:
    """Positions, or spreads with a `prefix`, (n_rows, n_coordinates) in mm, of predictions as `predict` writes them,
    subset by subset.
    """
    wanted = re.compile(rf"{prefix}m\d+_[xyz]")
    columns = stored[[name for name in stored.columns if wanted.fullmatch(name)]].to_numpy().T
    of_subsets = (np.flatnonzero((stored["subset"] == subset).to_numpy(dtype=bool)) for subset in subsets)
    # Column by column in memory, as pandas stores them: the order decides the last bit of a mean.
    return np.asarray(np.concatenate([columns.take(rows, axis=1) for rows in of_subsets], axis=1).T)


def _microseconds_per_row(estimator: Any, inputs: Array, repeats: int = 5) -> float:
    seconds = []
    for _ in range(repeats):
        start = time.perf_counter()
        estimator.predict(inputs)
        seconds.append(time.perf_counter() - start)
    return 1e6 * statistics.median(seconds) / len(inputs)
