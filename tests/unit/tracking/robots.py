"""A calibrated model of a small arm, and the result files that its version in the registry is logged from."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import joblib
import pandas as pd

from softkin.core.files import write_json
from softkin.core.job_records import record_job
from softkin.core.samples import SUBSETS
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.calibration_data import Shell
from softkin.uncertainty.intervals import INTERVAL_METHODS
from tests.conftest import bending_arm

DESCRIPTION = {"dataset": "finger", "title": "FINGER", "sha256": "ab" * 32, "origin": "published", "n_commands": 2}
DESCRIPTION |= {"n_markers": 1, "is_cut": False, "rows": dict.fromkeys(SUBSETS, 60)}
LEAK = {"severity": "leak", "sentence": "Nine rows of test stand in train.", "consequence": "It is training error."}


@cache
def robot(seed: int = 0, method: str = "scp_spread") -> CalibratedModel:
    """A Gaussian process on 60 rows, with the intervals of `method`."""
    train = bending_arm(60, seed=seed)
    settings = FitSettings({"kernel": "rbf", "trend": "linear", "max_iter": 5}, skip_constant=True, seed=0, threads=1)
    model = FittedModel("finger", MODELS["gp"], "tuned", fitted_model(MODELS["gp"], settings, train), train)
    return calibrated(model, INTERVAL_METHODS[method], bending_arm(60, seed=7))


def with_shells(model: CalibratedModel) -> CalibratedModel:
    """The same with a shell, as a model has that makes intervals for extrapolation."""
    train = model.train
    return replace(model, shells=[Shell(train.commands[:30], train.commands[30:], *[train.positions[30:]] * 2)])


def scores_of(model: CalibratedModel) -> dict[str, Any]:
    """The columns of a score that name the run."""
    return {"dataset": model.dataset, "model": model.spec.name, "preset": model.preset}


def point_metrics() -> pd.DataFrame:
    errors = {"euclidean_mean_mm": 0.25, "euclidean_p95_mm": 0.5, "rmse_mm": 0.125}
    return pd.DataFrame([scores_of(robot()) | {"subset": subset} | errors for subset in SUBSETS])


def interval_metrics(method: str = "scp_spread") -> pd.DataFrame:
    """Averages over moving coordinates, and joint intervals, at two levels."""
    scores = {"interval_method": method, "coordinate": "mean_informative", "mean_width_mm": 2.0, "winkler_mm": 3.0}
    scores |= {"winkler_without_gross_mm": 2.5, "n_commands": 40}
    joint = {"interval_method": "joint_intervals", "coordinate": "joint", "size_mm": 4.0}
    return pd.DataFrame(
        [
            scores_of(robot()) | of_method | {"subset": subset, "confidence_level": level, "coverage": level + more}
            for of_method, more in ((scores, 0.02), (joint, 0.01))
            for subset in ("test", "extrapolation")
            for level in (0.8, 0.9)
        ]
    )


def put_model(path: Path, model: CalibratedModel) -> None:
    """Write a calibrated model as its job does."""
    joblib.dump(model, path)
    record_job(path.parent / "logs" / "calibrate.log", [path])


def champion_files(folder: Path) -> dict[str, Any]:
    """Arguments of `log_champion`, as files in `folder`."""
    names = {"description": "dataset.json", "data_card": "data_card.json", "point": "point.csv"}
    names |= {"intervals": "intervals.csv", "calibrated_model": "calibrated_model.joblib"}
    files: dict[str, Any] = {name: folder / file for name, file in names.items()}
    write_json(files["description"], DESCRIPTION)
    write_json(files["data_card"], {"findings": [LEAK]})
    put_model(files["calibrated_model"], robot())
    point_metrics().to_csv(files["point"], index=False)
    interval_metrics().to_csv(files["intervals"], index=False)
    return files | {"parent": "the-campaign"}
