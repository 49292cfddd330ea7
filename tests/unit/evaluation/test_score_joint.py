"""Rows on the joint intervals of a calibrated model are what it answers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from softkin.evaluation.score_joint import joint_rows
from tests.conftest import bending_arm
from tests.unit.uncertainty.small_robot import small_robot

SAMPLES = {"test": bending_arm(90, seed=3), "extrapolation": bending_arm(70, seed=4, largest_command=1.8)}


def test_a_row_per_level_and_subset_says_what_the_model_answers() -> None:
    robot = small_robot(shells=True)
    rows = pd.DataFrame(joint_rows(robot, SAMPLES, [0.8, 0.9])).set_index(["subset", "confidence_level"])
    assert len(rows) == 4
    assert set(rows["interval_method"]) == {"joint_intervals"}
    assert set(rows["shape"]) == {robot.joint.shape.kind}
    for (subset, level), row in rows.iterrows():
        of = robot.joint_intervals(SAMPLES[subset].commands, level)
        assert row["coverage"] == np.mean(np.asarray(of.contains(SAMPLES[subset].positions)))
        assert row["size_mm"] == pytest.approx(np.median(of.sizes_mm))
        assert row["guarantee"] == ("joint" if subset == "test" else "no guarantee")
        assert row["n_calibration"] == 60
    test = rows.loc["test"]
    assert test["coverage"].between(test["coverage_low"], test["coverage_high"]).all()
    assert test["coverage_p_value"].between(0.01, 1).all()
    assert rows.loc["extrapolation"]["size_mm"].min() > test["size_mm"].max()


def test_blocks_of_any_size_count_alike() -> None:
    robot, rows = small_robot(), SAMPLES["test"]
    held = np.asarray(robot.joint_intervals(rows.commands, 0.8).contains(rows.positions))
    in_blocks = replace(rows, block=np.where(held, 0, 1))
    assert not held.all()
    assert [row["coverage"] for row in joint_rows(robot, {"test": in_blocks}, [0.8])] == [0.5]


def test_too_few_calibration_rows_are_said_to_be_infinite() -> None:
    rows = list(joint_rows(small_robot(), {"test": SAMPLES["test"]}, [0.999]))
    assert (rows[0]["coverage"], rows[0]["infinite_share"]) == (1.0, 1.0)
