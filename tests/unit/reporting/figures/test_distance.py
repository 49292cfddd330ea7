"""Error against distance from the training data."""

from __future__ import annotations

import numpy as np

from softkin.data.table import read_subset
from softkin.reporting.figures.distance import distances, frame, plot
from softkin.reporting.figures.spec import DatasetResults
from tests.unit.reporting.figures.conftest import OFF_MM, RUNS
from tests.unit.reporting.figures.drawn import ys


def test_distance_is_that_of_the_nearest_train_command_in_standard_deviations(results: DatasetResults) -> None:
    rows = frame(results)
    runs = rows[["model", "preset"]].drop_duplicates().apply(tuple, axis=1).tolist()
    assert runs == [("gp", "tuned"), ("gb", "paper")]
    train, test = (read_subset(results.table, name).commands for name in ("train", "test"))
    apart = np.linalg.norm((test[:, None] - train[None]) / train.std(axis=0), axis=-1).min(axis=1)
    of_test = rows[(rows["model"] == "gb") & (rows["subset"] == "test")]
    np.testing.assert_allclose(of_test["distance"], apart)
    np.testing.assert_allclose(of_test["error_mm"], 3**0.5 * OFF_MM[RUNS[0]])


def test_a_command_of_train_is_at_distance_zero(results: DatasetResults) -> None:
    [apart] = distances(results, [read_subset(results.table, "train").commands])
    assert (apart == 0.0).all()


def test_the_line_is_the_median_error(results: DatasetResults) -> None:
    rows = frame(results)
    lines = [ys(axes.lines[-1]) for axes in plot(rows, results).axes]
    for run, line in zip((RUNS[3], RUNS[0]), lines, strict=True):
        np.testing.assert_allclose(min(line), 3**0.5 * OFF_MM[run])
        np.testing.assert_allclose(max(line), 3 * 3**0.5 * OFF_MM[run])
