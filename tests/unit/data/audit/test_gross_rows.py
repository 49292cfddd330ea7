from __future__ import annotations

from dataclasses import replace

import numpy as np

from softkin.core.samples import Samples
from softkin.data.audit import gross_outliers, stuck_poses
from softkin.data.audit.gross_rows import gross_rows
from tests.unit.data.audit.conftest import Replace


def test_they_are_the_rows_that_the_audit_names(robot: dict[str, Samples], changed: Replace) -> None:
    train = robot["train"]
    samples = changed("train", [17, 200], positions=train.positions[[17, 200]] + np.array([0, 0, 0, 0, 40, 0]))
    samples = changed("test", [3], positions=train.positions[5], of=samples)
    named = [rows for check in (gross_outliers.check, stuck_poses.check) for rows in check(samples).findings]
    assert {finding.code for finding in named} == {"gross_outliers", "stuck_poses"}
    found = {subset: np.flatnonzero(mask).tolist() for subset, mask in gross_rows(samples).items()}
    assert found == {"train": [17, 200], "validation": [], "test": [3], "extrapolation": []}


def test_a_sound_robot_has_none_and_one_that_never_moves_neither(robot: dict[str, Samples]) -> None:
    still = {subset: replace(rows, positions=np.zeros_like(rows.positions)) for subset, rows in robot.items()}
    for samples in (robot, still):
        assert not any(mask.any() for mask in gross_rows(samples).values())


def test_train_and_validation_alone_will_do(changed: Replace) -> None:
    samples = changed("validation", [7], positions=np.zeros(6))
    masks = gross_rows({subset: samples[subset] for subset in ("train", "validation")})
    assert np.flatnonzero(masks["validation"]).tolist() == [7]
