"""The model that MLflow serves: predictions and intervals of a calibrated model.

MLflow copies this file into the registered model, with the package beside it.
"""

from __future__ import annotations

import hashlib
import io
from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pandas as pd
from mlflow.models import set_model
from mlflow.pyfunc.model import PythonModel

from softkin.core.errors import ResultError
from softkin.core.samples import coordinate_columns


class ServedModel(PythonModel):
    """Commands u1, u2, ... -> y_pred_m1_x, ..., lower_m1_x, ..., upper_m1_x, ..., joint_lower_m1_x, ...,
    joint_upper_m1_x, ... in mm, a row per command.

    A model that knows failures has a last column failure_probability; where it is high, intervals hold failed poses.
    The parameter `confidence_level` is that of the interval from lower to upper, and of the joint interval, whose
    bounds along the axes hold the whole pose.
    """

    def load_context(self, context: Any) -> None:
        """Read the calibrated model: unpickling runs what is in the file, so it must be the one that was registered.

        Raises:
            ResultError: it is another, by the hash that was registered with it.
        """
        file = Path(context.artifacts["calibrated_model"])
        content = file.read_bytes()
        if hashlib.sha256(content).hexdigest() != context.model_config["sha256"]:
            raise ResultError(
                "changed since it was registered; it is not loaded, since loading runs what is in it",
                where=file,
                fix="delete this version in MLflow and register the model again from results/: make store",
            )
        self.model = joblib.load(io.BytesIO(content))

    def predict(self, context: Any, model_input: pd.DataFrame, params: dict[str, Any] | None = None) -> pd.DataFrame:  # noqa: ARG002
        """Positions and intervals in mm, a row per command."""
        commands = np.asarray(model_input, dtype=np.float64)
        positions = self.model.predict(commands)
        level = (params or {})["confidence_level"]
        intervals = self.model.intervals(commands, level, positions)
        joint = self.model.joint_intervals(commands, level).bounds
        parts = {"y_pred": positions, "lower": intervals[..., 0], "upper": intervals[..., 1]}
        parts |= {"joint_lower": joint[..., 0], "joint_upper": joint[..., 1]}
        names = coordinate_columns(positions.shape[1] // 3)
        table = pd.DataFrame(
            np.hstack(list(parts.values())), columns=[f"{part}_{name}" for part in parts for name in names]
        )
        probability = self.model.failure_probability(commands)
        return table if probability is None else table.assign(failure_probability=probability)


set_model(ServedModel())
