from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from softkin.data.table import read_subset
from softkin.evaluation.score_orientation import score_orientation
from softkin.uncertainty.orientation_model import OrientationModel
from tests.oriented_robot import oriented_table


class Still:
    """Always the mean rotation."""

    def predict(self, inputs: np.ndarray) -> np.ndarray:
        return np.zeros((len(inputs), 3))


def test_each_subset_and_level_has_its_row(tmp_path: Path) -> None:
    table = tmp_path / "table.parquet"
    mean = np.array(oriented_table(table)["orientation"]["mean_vector"])
    model = OrientationModel("still", {}, Still(), mean, np.arange(1.0, 100.0), None, np.array([3.0, 4.0]))
    score_orientation(model, table, dataset="arm", confidence_levels=[0.5, 0.9], output=tmp_path / "scores.csv")
    scores = pd.read_csv(tmp_path / "scores.csv")
    assert scores["subset"].tolist() == ["train"] * 2 + ["test"] * 2 + ["extrapolation"] * 2
    assert scores["bound_deg"].tolist() == [50.0, 90.0] * 3
    held_out, test = scores.iloc[1], scores.iloc[2]
    assert (held_out.mean_deg, held_out.rms_deg, held_out.coverage) == (3.5, np.sqrt(12.5), 1.0)
    lengths = np.degrees(np.linalg.norm(np.asarray(read_subset(table, "test").orientation), axis=1))
    np.testing.assert_allclose([test.mean_deg, test.coverage], [lengths.mean(), (lengths <= 50).mean()])
    assert scores["guarantee"].tolist() == ["no guarantee"] * 2 + ["marginal"] * 2 + ["no guarantee"] * 2
