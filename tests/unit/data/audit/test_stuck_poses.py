from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Samples
from softkin.data.audit.stuck_poses import check
from tests.unit.data.audit.clean_robot import clean_robot, poses
from tests.unit.data.audit.conftest import Replace


def test_rows_that_keep_the_pose_of_another_are_found_and_the_right_one_is_spared(
    robot: dict[str, Samples], changed: Replace
) -> None:
    train = robot["train"]
    samples = changed("train", [50, 60, 70], positions=train.positions[5])
    samples = changed("test", [3], positions=train.positions[9], of=samples)
    result = check(samples)
    (finding,) = result.findings
    assert (finding.code, finding.severity) == ("stuck_poses", "warning")
    assert finding.rows == {"train": (50, 60, 70), "test": (3,)}
    misses = [*train.positions[[50, 60, 70]] - train.positions[5], robot["test"].positions[3] - train.positions[9]]
    assert result.numbers["largest_miss_mm"] == pytest.approx(np.abs(misses).max(), abs=1.0)
    assert result.numbers["poses"] == 2


def test_a_sensor_that_freezes_for_most_of_the_time_is_found(robot: dict[str, Samples], changed: Replace) -> None:
    result = check(changed("train", slice(100, 380), positions=robot["train"].positions[100]))
    assert result.numbers["rows"]["train"] > 250


def test_a_marker_that_never_moves_is_not_stuck(robot: dict[str, Samples]) -> None:
    samples = {
        subset: Samples(rows.commands, np.hstack([np.zeros((len(rows), 3)), rows.positions]))
        for subset, rows in robot.items()
    }
    result = check(samples)
    assert not result.findings
    assert result.numbers["poses"] == 0


@pytest.mark.parametrize("resolution_mm", [0.1, 1.0, 5.0])
def test_a_coarse_sensor_shares_poses_rightly(resolution_mm: float) -> None:
    samples = {
        subset: Samples(rows.commands, np.round(rows.positions / resolution_mm) * resolution_mm)
        for subset, rows in clean_robot(3000, seed=1).items()
    }
    result = check(samples)
    assert not result.findings


def test_redundant_actuators_share_poses_rightly() -> None:
    rng = np.random.default_rng(0)
    pulls = rng.integers(0, 8, (1500, 4)).astype(float)  # two antagonistic pairs: only differences move the arm
    pulls = np.unique(pulls, axis=0)
    positions = poses((pulls[:, ::2] - pulls[:, 1::2]) / 8, 1, 0)
    parts = np.array_split(rng.permutation(len(pulls)), 4)
    names = ("train", "validation", "test", "extrapolation")
    samples = {name: Samples(pulls[part], positions[part]) for name, part in zip(names, parts, strict=True)}
    assert len(np.unique(positions, axis=0)) < len(pulls) / 2
    assert not check(samples).findings


def test_equal_rows_are_not_stuck(robot: dict[str, Samples], changed: Replace) -> None:
    train = robot["train"]
    assert not check(changed("train", [50, 60], commands=train.commands[5], positions=train.positions[5])).findings


def test_where_no_plane_can_be_fitted_every_shared_pose_counts() -> None:
    samples = clean_robot(100, n_commands=64, n_markers=2, seed=0)
    positions = samples["train"].positions.copy()
    positions[3] = positions[7]
    (finding,) = check({**samples, "train": Samples(samples["train"].commands, positions)}).findings
    assert finding.rows == {"train": (3, 7)}
    assert " mm " not in finding.sentence


def test_a_robot_that_never_moves_is_left_to_another_check(robot: dict[str, Samples]) -> None:
    still = {subset: Samples(rows.commands, np.ones_like(rows.positions)) for subset, rows in robot.items()}
    result = check(still)
    assert not result.findings
    assert result.numbers == {"not_measured": "no coordinate moves"}
