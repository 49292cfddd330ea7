from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import joblib
import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import ResultError
from softkin.core.files import file_sha256
from softkin.tracking.served_model import ServedModel
from tests.conftest import bending_arm
from tests.unit.tracking.robots import robot
from tests.unit.uncertainty.test_failures import robot as failing_robot

COMMANDS = bending_arm(12, seed=9).commands


@pytest.fixture
def served(tmp_path: Path) -> ServedModel:
    joblib.dump(robot(), tmp_path / "model.joblib")
    model = ServedModel()
    model.load_context(context(tmp_path / "model.joblib", file_sha256(tmp_path / "model.joblib")))
    return model


def context(file: Path, sha256: str) -> SimpleNamespace:
    return SimpleNamespace(artifacts={"calibrated_model": str(file)}, model_config={"sha256": sha256})


class Runs:
    """What runs when it is unpickled."""

    def __reduce__(self) -> tuple[Any, ...]:
        return pytest.fail, ("it was run",)


def test_a_file_that_is_not_the_one_that_was_registered_is_never_run(tmp_path: Path) -> None:
    file = tmp_path / "model.joblib"
    joblib.dump(robot(), file)
    registered = file_sha256(file)
    joblib.dump(Runs(), file)
    with pytest.raises(ResultError, match="changed since it was registered") as refused:
        ServedModel().load_context(context(file, registered))
    assert refused.value.where == str(file)


def answer(served: ServedModel, level: float) -> pd.DataFrame:
    commands = pd.DataFrame(COMMANDS, columns=["u1", "u2"])
    params: dict[str, Any] = {"confidence_level": level}
    table: pd.DataFrame = served.predict(None, commands, params)
    return table


def test_positions_and_bounds_stand_in_named_columns(served: ServedModel) -> None:
    table = answer(served, 0.9)
    parts = ("y_pred", "lower", "upper", "joint_lower", "joint_upper")
    assert list(table) == [f"{part}_m1_{axis}" for part in parts for axis in "xyz"]
    assert len(table) == len(COMMANDS)


@pytest.mark.parametrize("level", [0.8, 0.95])
def test_they_are_those_of_the_calibrated_model(served: ServedModel, level: float) -> None:
    table = answer(served, level)
    bounds = robot().intervals(COMMANDS, [level])[0]
    np.testing.assert_array_equal(table.filter(like="y_pred"), robot().predict(COMMANDS))
    joint = np.asarray(robot().joint_intervals(COMMANDS, level).bounds)
    for prefix, expected in (("", bounds), ("joint_", joint)):
        np.testing.assert_array_equal(table.filter(regex=f"^{prefix}lower"), expected[..., 0])
        np.testing.assert_array_equal(table.filter(regex=f"^{prefix}upper"), expected[..., 1])


def test_a_higher_level_is_a_wider_interval(served: ServedModel) -> None:
    narrow, wide = answer(served, 0.8), answer(served, 0.95)
    assert (wide["upper_m1_x"] - wide["lower_m1_x"] > narrow["upper_m1_x"] - narrow["lower_m1_x"]).all()


def test_without_a_level_there_is_no_interval(served: ServedModel) -> None:
    with pytest.raises(KeyError, match="confidence_level"):
        served.predict(None, pd.DataFrame(COMMANDS, columns=["u1", "u2"]))


def test_a_robot_that_fails_says_how_probably(served: ServedModel) -> None:
    assert "failure_probability" not in answer(served, 0.9)
    served.model = failing_robot()
    np.testing.assert_array_equal(
        answer(served, 0.9)["failure_probability"], failing_robot().failure_probability(COMMANDS)
    )
