from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from softkin.core.rotations import angles, from_mean
from softkin.core.samples import SUBSETS
from softkin.data.table import read_subset, to_table, write_table
from softkin.models.of_orientation import CANDIDATES
from softkin.training import orientation
from softkin.uncertainty.build_orientation_model import orientation_model
from tests.oriented_robot import oriented_table


def test_it_is_fitted_on_train_and_calibrated_on_validation_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(orientation, "CANDIDATES", CANDIDATES[:2])
    description = oriented_table(tmp_path / "table.parquet")
    made = orientation_model(tmp_path / "table.parquet", description, seed=0, threads=1)
    subsets = {name: read_subset(tmp_path / "table.parquet", name) for name in SUBSETS}
    np.testing.assert_allclose(made.scores, made.angles(subsets["validation"]))
    there = from_mean(np.asarray(subsets["test"].orientation), made.mean)
    missed = angles(made.vectors(subsets["test"].inputs), there)
    np.testing.assert_allclose(missed, made.angles(subsets["test"]), atol=1e-6)

    spoilt = {name: replace(rows, orientation=np.asarray(rows.orientation)[::-1]) for name, rows in subsets.items()}
    write_table(to_table(spoilt | {"train": subsets["train"]}), tmp_path / "spoilt.parquet")
    again = orientation_model(tmp_path / "spoilt.parquet", description, seed=0, threads=1)
    np.testing.assert_array_equal(again.vectors(subsets["test"].inputs), made.vectors(subsets["test"].inputs))
    assert again.scores.mean() > 2 * made.scores.mean()
