"""Fit one model on `train`, predict every subset."""

from __future__ import annotations

import logging
import statistics
import time
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pandas as pd
from sklearn.exceptions import ConvergenceWarning
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from threadpoolctl import threadpool_limits

from softkin.datasets.table import read_subset
from softkin.estimators.kinematic_regressor import KinematicRegressor
from softkin.files import replacing, write_json
from softkin.interface import SUBSETS, TEST, TRAIN, Array, ModelSpec, Params, Samples, coordinate_columns
from softkin.job import stopwatch
from softkin.rows import sampled_rows
from softkin.target_spaces import TARGET_SPACES

logger = logging.getLogger("softkin")

#: What the columns of a model's spread start with.
STANDARD_DEVIATION, SPREAD = "std_", "spread_"


def kinematic_model(
    spec: ModelSpec,
    params: Params,
    *,
    skip_constant: bool,
    seed: int,
    threads: int,
    target_space: str = "cartesian",
    base: Mapping[str, Any] | None = None,
) -> Any:
    """Unfitted regressor commands -> positions in mm; both are standardised inside, by what it is fitted on.

    `base` is what the dataset's entry declares of the robot's base, for a target space that needs to know it.
    """
    return KinematicRegressor(
        make_pipeline(StandardScaler(), spec.build(params, seed, threads)),
        TARGET_SPACES[target_space].transformer(skip_constant, base),
    )


def fit_quietly(estimator: Any, samples: Samples, threads: int) -> int:
    """Fit in place on at most `threads` threads; return how many solvers stopped at their iteration bound.

    The bounds are deliberate (no fit may run away), so their warnings are counted, not printed.
    """
    with warnings.catch_warnings(record=True) as caught, threadpool_limits(threads):
        warnings.simplefilter("always")
        estimator.fit(samples.commands, samples.positions)
    stopped = [w for w in caught if issubclass(w.category, ConvergenceWarning)]
    for message in {str(w.message) for w in caught if w not in stopped}:
        logger.warning("%s", message)
    return len(stopped)


def some_rows(samples: Samples, max_rows: int | None, seed: int) -> Samples:
    """At most `max_rows` rows, drawn without replacement, in their order; all where it is None."""
    if max_rows is None or len(samples) <= max_rows:
        return samples
    logger.warning("fitted on %d of %d rows: max_fit_rows", max_rows, len(samples))
    rows = sampled_rows(len(samples), max_rows, seed)
    return Samples(samples.commands[rows], samples.positions[rows])


def fit(
    table: str | Path,
    *,
    spec: ModelSpec,
    params: Params,
    skip_constant: bool,
    seed: int,
    threads: int,
    model: str | Path,
    record: str | Path,
    target_space: str = "cartesian",
    base: Mapping[str, Any] | None = None,
    max_rows: int | None = None,
) -> None:
    """Fit on `train` of `table`; write the fitted `model` (joblib) and a `record` (JSON) of what it took.

    `max_rows` bounds the rows of a model that cannot take more: the rest is left out at random, and the log says so.
    """
    samples = some_rows(read_subset(table, TRAIN), max_rows, seed)
    estimator = kinematic_model(
        spec, params, skip_constant=skip_constant, seed=seed, threads=threads, target_space=target_space, base=base
    )
    with stopwatch() as watch:
        stopped = fit_quietly(estimator, samples, threads)
    with replacing(model) as temporary:
        joblib.dump(estimator, temporary, compress=3)
    write_json(
        record,
        {
            "params": params,
            "skip_constant": skip_constant,
            "target_space": target_space,
            "base": base,
            "n_train": len(samples),
            "solvers_at_iteration_bound": stopped,
            "fit_seconds": watch.seconds,
            "fit_cpu_seconds": watch.cpu_seconds,
        },
    )
    logger.info("fitted on %d rows in %.1f s", len(samples), watch.seconds)


def spread_of(spec: ModelSpec, estimator: Any, train: Samples, commands: Array) -> Array:
    """What a fitted kinematic model says itself of its uncertainty at `commands`: (n_rows, n_coordinates) in mm."""
    assert spec.spread is not None
    scaler, regressor = estimator.regressor_[0], estimator.regressor_[-1]
    known = Samples(scaler.transform(train.commands), estimator.transformer_.transform(train.positions))
    spread = spec.spread(regressor, known, scaler.transform(commands))
    return np.asarray(estimator.transformer_.inverse_spread(estimator.targets(commands), spread))


def predict(
    table: str | Path,
    *,
    spec: ModelSpec,
    model: str | Path,
    threads: int,
    predictions: str | Path,
    record: str | Path,
) -> None:
    """Write the `predictions` (Parquet: subset, m1_x.. in mm, rows as in `table`) of every subset, and how long
    `test` takes a row (median of five). A model with a spread gets columns for it too: std_m1_x.. (mm) where
    it is a predictive standard deviation, else spread_m1_x...
    """
    estimator = joblib.load(model)
    train = read_subset(table, TRAIN)
    frames = []
    with threadpool_limits(threads):
        for subset in SUBSETS:
            commands = (train if subset == TRAIN else read_subset(table, subset)).commands
            frames.append(_frame(subset, np.asarray(estimator.predict(commands))))
            if spec.spread is not None:
                spread = _frame(subset, spread_of(spec, estimator, train, commands))
                prefix = STANDARD_DEVIATION if spec.is_predictive else SPREAD
                frames[-1] = pd.concat([frames[-1], spread.iloc[:, 1:].add_prefix(prefix)], axis=1)
            if subset == TEST:
                microseconds = _microseconds_per_row(estimator, commands)
    with replacing(predictions) as temporary:
        pd.concat(frames, ignore_index=True).to_parquet(temporary, index=False)
    write_json(record, {"predict_us_per_row": microseconds})


def _frame(subset: str, positions: Array) -> pd.DataFrame:
    columns: Sequence[str] = coordinate_columns(positions.shape[1] // 3)
    frame = pd.DataFrame(positions, columns=columns)
    frame.insert(0, "subset", subset)
    return frame


def _microseconds_per_row(estimator: Any, commands: Array, repeats: int = 5) -> float:
    seconds = []
    for _ in range(repeats):
        start = time.perf_counter()
        estimator.predict(commands)
        seconds.append(time.perf_counter() - start)
    return 1e6 * statistics.median(seconds) / len(commands)
