from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Samples
from softkin.data.audit.gross_outliers import check
from tests.unit.data.audit.clean_robot import clean_robot
from tests.unit.data.audit.conftest import Replace


def test_lost_markers_are_found(robot: dict[str, Samples], changed: Replace) -> None:
    train = robot["train"]
    samples = changed("train", [17, 200], positions=train.positions[[17, 200]] + np.array([0, 0, 0, 0, 40, 0]))
    samples = changed("test", [3], positions=np.zeros(6), of=samples)
    samples = changed(
        "extrapolation", [9], positions=robot["extrapolation"].positions[9][[3, 4, 5, 0, 1, 2]], of=samples
    )
    result = check(samples)
    (finding,) = result.findings
    assert (finding.code, finding.severity) == ("gross_outliers", "warning")
    assert finding.rows == {"train": (17, 200), "test": (3,), "extrapolation": (9,)}
    assert result.numbers["largest_miss_mm"] > 39


def test_many_outliers_do_not_hide_each_other(robot: dict[str, Samples], changed: Replace) -> None:
    rows = np.arange(0, 392, 20)
    result = check(changed("train", rows, positions=robot["train"].positions[rows] + 60.0))
    assert result.findings[0].rows["train"] == tuple(rows.tolist())


def test_a_fault_that_is_off_by_less_than_a_hundredth_of_the_reach_is_not_gross(
    robot: dict[str, Samples], changed: Replace
) -> None:
    assert not check(changed("train", [17], positions=robot["train"].positions[17] + 0.3)).findings


def test_noise_that_grows_with_the_command_is_no_finding() -> None:
    rng = np.random.default_rng(0)
    samples = {
        subset: Samples(
            rows.commands,
            rows.positions
            + (3 * np.linalg.norm(rows.commands, axis=1) ** 3)[:, None] * rng.standard_normal(rows.positions.shape),
        )
        for subset, rows in clean_robot(2000, seed=2).items()
    }
    assert not check(samples).findings


@pytest.mark.parametrize("noise_mm", [0.0, 0.1, 5.0])
def test_a_jump_of_the_robot_is_not_an_outlier(noise_mm: float) -> None:
    """It snaps over where u1 exceeds 0.2: a third of its rows lie on another branch."""
    samples = {
        subset: Samples(rows.commands, rows.positions + 30.0 * (rows.commands[:, :1] > 0.2))
        for subset, rows in clean_robot(2000, noise_mm=noise_mm, seed=2).items()
    }
    assert not check(samples).findings


def test_with_too_few_rows_it_says_that_it_did_not_look() -> None:
    result = check(clean_robot(100, n_commands=64, n_markers=2, seed=0))
    assert not result.findings
    assert "too few" in result.numbers["not_measured"]
