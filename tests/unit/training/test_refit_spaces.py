from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from softkin.core.files import write_json
from softkin.core.samples import SUBSETS, Samples
from softkin.data.table import read_subset, to_table, write_table
from softkin.models import MODELS
from softkin.training.refit_spaces import refit_spaces
from tests.conftest import bending_arm

BEST = {
    "target_space": "cartesian",
    "memory": None,
    "params": {"degree": 1, "interaction_only": False},
    "shell_mae_mm": 1.0,
}
BASE = {"origin": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0]}


def refitted(table: Path, folder: Path, others: dict[str, object]) -> pd.DataFrame:
    for model, other in others.items():
        write_json(folder / f"{model}.json", BEST | {"other_space": other})
    refit_spaces(
        table,
        specs={model: MODELS[model] for model in others},
        parameters={model: folder / f"{model}.json" for model in others},
        base=BASE,
        max_fit_rows={"ridge": 20},
        seed=0,
        threads=1,
        predictions=folder / "others.parquet",
    )
    return pd.read_parquet(folder / "others.parquet")


def test_a_model_is_fitted_in_the_space_that_was_not_chosen(tmp_path: Path) -> None:
    """This robot is a straight line from commands to arcs; positions of other subsets are garbage and are not read."""
    arms = {subset: bending_arm(80, seed=place) for place, subset in enumerate(SUBSETS)}
    garbage = arms | {s: Samples(arms[s].commands, arms[s].positions + 1e6) for s in ("test", "extrapolation")}
    write_table(to_table(garbage), tmp_path / "table.parquet")
    other = {"target_space": "curvature", "memory": None, "params": BEST["params"], "shell_mae_mm": 0.1}
    ridge = other | {"params": {"degree": 2, "alpha": 1e-6}}
    frame = refitted(tmp_path / "table.parquet", tmp_path, {"lr": other, "gp": None, "ridge": ridge})
    assert set(zip(frame["model"], frame["target_space"], strict=True)) == {("lr", "curvature"), ("ridge", "curvature")}
    for subset in ("test", "extrapolation"):
        predicted = frame[(frame["model"] == "lr") & (frame["subset"] == subset)]
        errors = predicted[["m1_x", "m1_y", "m1_z"]].to_numpy(np.float64) - arms[subset].positions
        assert np.abs(errors).mean() < 0.2


def test_a_robot_that_the_other_space_does_not_hold_is_left_out(tmp_path: Path) -> None:
    arms = {subset: bending_arm(30, seed=place) for place, subset in enumerate(SUBSETS)}
    behind = {subset: Samples(rows.commands, -rows.positions * [0, 0, 1]) for subset, rows in arms.items()}
    write_table(to_table(behind), tmp_path / "table.parquet")
    frame = refitted(tmp_path / "table.parquet", tmp_path, {"lr": BEST | {"target_space": "curvature"}})
    assert frame.empty
    assert len(read_subset(tmp_path / "table.parquet", "train")) == 30
