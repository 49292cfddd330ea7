"""Error against distance from the training data."""

from __future__ import annotations

import numpy as np

from softkin.data.table import read_subset
from softkin.reporting.figures.distance import frame
from softkin.reporting.figures.spec import DatasetResults
from tests.unit.reporting.figures.conftest import OFF_MM


def test_distance_is_that_of_the_nearest_train_command_in_standard_deviations(results: DatasetResults) -> None:
    rows = frame(results)
    runs = rows[["model", "preset"]].drop_duplicates().apply(tuple, axis=1).tolist()
    assert runs == [("gp", "tuned"), ("gb", "paper")]
    train, test = (read_subset(results.table, name).commands for name in ("train", "test"))
    apart = np.linalg.norm((test[:, None] - train[None]) / train.std(axis=0), axis=-1).min(axis=1)
    mine = rows[(rows["model"] == "gb") & (rows["subset"] == "test")]
    np.testing.assert_allclose(mine["distance"], apart)
    np.testing.assert_allclose(mine["error_mm"], 3**0.5 * OFF_MM["gb", "paper"])
