"""The calibrated model that a choice deploys, as one file."""

from __future__ import annotations

from pathlib import Path

import joblib
import numpy as np
import pandas as pd

from softkin.core.files import write_json
from softkin.core.job_records import record_job
from softkin.core.samples import SUBSETS, TRAIN, VALIDATION
from softkin.data.table import content_hash, to_table, write_table
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.build_calibrated_model import build_calibrated_model
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.stored_outputs import StoredOutputs
from tests.recorded_robot import recorded_arm


def test_a_recorded_robot_keeps_its_memory_in_the_file(tmp_path: Path) -> None:
    rows = recorded_arm(240, backlash=0.05, zeros_mm=(0.0, 1.0))
    parts = {subset: rows.take(np.arange(240) % 4 == place) for place, subset in enumerate(SUBSETS)}
    write_table(to_table(parts), tmp_path / "table.parquet")
    memory = {"memory": "previous", "zeros": True}
    settings = FitSettings({"degree": 2, "alpha": 1e-3}, True, 0, 1, memory=memory)
    joblib.dump(fitted_model(MODELS["ridge"], settings, parts[TRAIN]), tmp_path / "model.joblib")
    columns = {"commands": ["left", "right"], "positions": ["x", "y", "z"], "mm_per_unit": 10.0, "dimensions": 3}
    write_json(tmp_path / "dataset.json", {"dataset": "arm", "columns": columns})
    record_job(tmp_path / "logs" / "fit_model.log", [tmp_path / "model.joblib"])
    choice = {"model": "ridge", "preset": "tuned", "interval_method": "scp_crepes", "outside": "scp_crepes"}
    pd.DataFrame([choice | {"deployed": True}]).to_csv(tmp_path / "choice.csv", index=False)
    build_calibrated_model(
        StoredOutputs(tmp_path / "table.parquet", predictions={}, quantiles={}, refits=None, confidence_levels=[0.9]),
        description=tmp_path / "dataset.json",
        choice=tmp_path / "choice.csv",
        specs=MODELS,
        methods=INTERVAL_METHODS,
        models={("ridge", "tuned"): tmp_path / "model.joblib"},  # type: ignore[dict-item]
        output=tmp_path / "robot.joblib",
    )
    robot = joblib.load(tmp_path / "robot.joblib")
    np.testing.assert_allclose(robot.known.calibration, robot.predict(parts[VALIDATION].inputs))
    first = rows.take(np.arange(20))
    np.testing.assert_allclose(robot.follow(first.commands, session=1), robot.predict(first.inputs))
    assert robot.about == {"data": content_hash(parts[TRAIN]), "columns": columns}
    swapped = pd.DataFrame(first.commands[:, ::-1], columns=["right", "left"])
    np.testing.assert_array_equal(robot.predict(swapped), robot.predict(first.commands))
