"""Readers of a dataset's results that several figures share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.metrics.point import euclidean_errors
from softkin.core.runs import Run
from softkin.core.samples import TEST, TRAIN, Array, coordinate_columns, informative_coordinates
from softkin.data.table import read_subset
from softkin.reporting.figures.spec import DatasetResults


@dataclass(frozen=True, slots=True)
class Deployed:
    """The deployed run, and the best interval method around it at the level at which methods were compared."""

    model: str
    preset: str
    interval_method: str
    confidence_level: float

    @property
    def run(self) -> Run:
        """The run whose predictions the intervals surround."""
        return Run(self.model, self.preset)


def deployed(results: DatasetResults) -> Deployed | None:
    """The deployed run and interval method; None when only methods with quantile regressors of their own were run."""
    choice = candidates(results)
    around = choice[~choice["has_own_regressors"]]
    if around.empty:
        return None
    best = around.iloc[0]
    return Deployed(best["model"], best["preset"], best["interval_method"], float(best["confidence_level"]))


def candidates(results: DatasetResults) -> pd.DataFrame:
    """Rows of interval_choice.csv, best first, with a column `has_own_regressors`."""
    choice = read_csv(results.choice)
    return choice.assign(
        has_own_regressors=choice["interval_method"].map(dict(results.has_own_regressors)).astype(bool)
    )


def shown_coordinate(results: DatasetResults) -> tuple[int, str]:
    """Number and name of the coordinate that moves furthest on `train`."""
    positions = read_subset(results.table, TRAIN).positions
    coordinate = int(np.argmax(np.ptp(positions, axis=0)))
    return coordinate, coordinate_columns(positions.shape[1] // 3)[coordinate]


def predicted(results: DatasetResults, run: Run, subset: str, columns: list[str]) -> Array:
    """Predictions (n_rows, n_columns) of these coordinates by a run on a subset; mm."""
    frame = pd.read_parquet(results.predictions[run], columns=columns, filters=[("subset", "==", subset)])
    return np.ascontiguousarray(frame.to_numpy(np.float64))


def bounds(
    results: DatasetResults,
    method: str,
    run: Run,
    confidence_level: float,
    coordinates: Sequence[str],
    subset: str = TEST,
) -> Array | None:
    """Intervals of these coordinates on a subset, (n_rows, n_coordinates, 2) in mm; None when there are none.

    Nothing else is read of the file, which holds all runs and levels and is the largest of the results.
    """
    key = {"model": run.model, "preset": run.preset, "subset": subset, "confidence_level": confidence_level}
    columns = [f"{side}_{name}" for name in coordinates for side in ("lower", "upper")]
    stored = pd.read_parquet(
        results.intervals[method], columns=columns, filters=[(name, "==", value) for name, value in key.items()]
    )
    return None if stored.empty else stored.to_numpy(np.float64).reshape(len(stored), len(coordinates), 2)


def mean_marker_errors(results: DatasetResults, run: Run, subset: str) -> Array:
    """Distance between true and predicted marker, (n_rows,), averaged over the moving markers; mm."""
    moving = informative_coordinates(read_subset(results.table, TRAIN).positions)
    true = read_subset(results.table, subset).positions
    columns = coordinate_columns(true.shape[1] // 3)
    errors = euclidean_errors(true, predicted(results, run, subset, columns))
    return np.asarray(errors[:, moving.reshape(-1, 3).any(axis=1)].mean(axis=1))
