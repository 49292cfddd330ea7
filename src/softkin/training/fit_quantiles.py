"""Fit quantile regressors on `train`, predict the quantiles of every other subset."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import joblib
import numpy as np
import pandas as pd
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

from softkin.core.bounds import bounds_frame
from softkin.core.clocks import counted_as_fit, stopwatch
from softkin.core.files import replacing, write_json
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, VALIDATION, Array, Params, Samples
from softkin.core.threads import limited_threads
from softkin.data.table import read_subset
from softkin.models.quantile.spec import QuantileSpec
from softkin.training.bounded_rows import some_rows

logger = logging.getLogger("softkin")

PREDICTED_SUBSETS = (VALIDATION, TEST, EXTRAPOLATION)


def quantiles_of(confidence_levels: Sequence[float]) -> list[float]:
    """alpha/2 and 1 - alpha/2 of each level: [l1, u1, l2, u2, ...], as short decimals."""
    return [round(q, 12) for level in confidence_levels for q in ((1 - level) / 2, (1 + level) / 2)]


class QuantileModel:
    """One quantile regressor per coordinate; a coordinate that never varies has its constant as quantiles."""

    def __init__(
        self, spec: QuantileSpec, params: Params, confidence_levels: Sequence[float], seed: int, threads: int
    ) -> None:
        self.spec, self.params, self.levels = spec, params, list(confidence_levels)
        self.seed, self.threads = seed, threads

    def fit(self, samples: Samples) -> QuantileModel:
        """Fit one regressor per coordinate that varies, in standardised space."""
        self.means, self.scales = samples.positions.mean(axis=0), samples.positions.std(axis=0)
        self.constants = samples.positions[0].copy()
        self.models = {}
        for coordinate in np.flatnonzero(np.ptp(samples.positions, axis=0) > 0):
            standardised = (samples.positions[:, coordinate] - self.means[coordinate]) / self.scales[coordinate]
            regressor = self.spec.build(self.params, quantiles_of(self.levels), self.seed, self.threads)
            self.models[int(coordinate)] = make_pipeline(StandardScaler(), regressor).fit(
                samples.commands, standardised
            )
        return self

    def predict(self, commands: Array) -> Array:
        """Predicted quantiles (n_levels, n_rows, n_coordinates, 2) in mm, which may cross."""
        result = np.empty((len(self.levels), len(commands), len(self.constants), 2))
        result[:] = self.constants[:, None]
        for coordinate, model in self.models.items():
            flat = model.predict(commands) * self.scales[coordinate] + self.means[coordinate]
            result[:, :, coordinate] = flat.reshape(len(commands), len(self.levels), 2).transpose(1, 0, 2)
        return result


@dataclass(frozen=True, slots=True)
class QuantileFiles:
    """Files of one fit: the `model` (joblib), the `quantiles` of validation, test and extrapolation in mm (Parquet, see
    `bounds_frame`), a `record` of settings and times (JSON).
    """

    model: str | Path
    quantiles: str | Path
    record: str | Path


def fit_quantiles(
    table: str | Path, *, regressor: QuantileModel, files: QuantileFiles, max_rows: int | None = None
) -> None:
    """Fit `regressor` on `train` of `table`; write it, the quantiles that it predicts and a record of its times.

    Parameters:
        table: path of the tidy table (Parquet).
        regressor: the unfitted quantile regressors of all coordinates.
        files: where they go.
        max_rows: rows at most, as of `fit`.
    """
    samples = some_rows(read_subset(table, TRAIN), max_rows, regressor.seed)
    with stopwatch() as watch, limited_threads(regressor.threads), counted_as_fit():
        regressor.fit(samples)
    with replacing(files.model) as temporary:
        joblib.dump(regressor, temporary, compress=3)
    frames = []
    for subset in PREDICTED_SUBSETS:
        predicted = regressor.predict(read_subset(table, subset).commands)
        frames += [bounds_frame(predicted[i], subset, level) for i, level in enumerate(regressor.levels)]
    with replacing(files.quantiles) as temporary:
        pd.concat(frames, ignore_index=True).to_parquet(temporary, index=False)
    times = {"fit_seconds": watch.seconds, "fit_cpu_seconds": watch.cpu_seconds}
    write_json(files.record, {"params": regressor.params, "n_train": len(samples), **times})
    logger.info("fitted %d quantiles in %.1f s", 2 * len(regressor.levels), watch.seconds)
