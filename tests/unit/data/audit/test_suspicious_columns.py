from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from softkin.core.samples import SUBSETS, Array, Samples
from softkin.data.audit.suspicious_columns import check
from softkin.data.readers import table_file
from tests.conftest import HOUSE
from tests.unit.data.audit.conftest import Replace


def with_commands(robot: dict[str, Samples], **told: Callable[[Samples], Array]) -> dict[str, Samples]:
    """The robot with further commands, made of all rows of each subset by a function of its samples."""
    return {
        name: Samples(np.column_stack([rows.commands, *(make(rows) for make in told.values())]), rows.positions)
        for name, rows in robot.items()
    }


def codes(samples: dict[str, Samples]) -> dict[str, str]:
    findings = check(samples).findings
    assert all(finding.subsets == SUBSETS for finding in findings)
    return {finding.code: finding.sentence for finding in findings}


def test_a_clean_robot_is_not_suspicious(robot: dict[str, Samples]) -> None:
    result = check(robot)
    assert result.findings == ()
    assert result.numbers["rows_looked_at"] == 700


def test_a_position_that_is_an_affine_map_of_commands_is_named(robot: dict[str, Samples], changed: Replace) -> None:
    samples = robot
    for name, rows in robot.items():
        positions = rows.positions.copy()
        positions[:, 4] = 3.0 + rows.commands @ [20.0, -30.0]
        samples = changed(name, slice(None), positions=positions, of=samples)
    found = codes(samples)
    assert set(found) == {"suspicious_affine"}
    assert "u1, u2 gives m2_y to" in found["suspicious_affine"]
    noisy = changed("test", [3], positions=samples["test"].positions[3] + 0.1, of=samples)
    assert "suspicious_affine" not in codes(noisy)


def test_a_command_that_is_a_difference_of_markers_is_named(robot: dict[str, Samples]) -> None:
    found = codes(with_commands(robot, error=lambda rows: rows.positions[:, 3] - rows.positions[:, 0]))
    assert found["suspicious_affine"] == "u3 is the difference of m1_x and m2_x."


@pytest.mark.parametrize("length", [3, 4])
def test_commands_of_unit_norm_are_an_orientation(robot: dict[str, Samples], length: int) -> None:
    rng = np.random.default_rng(0)

    def quaternion(rows: Samples) -> Array:
        values = rng.normal(size=(len(rows), length))
        return np.asarray(values / np.linalg.norm(values, axis=1, keepdims=True))

    found = codes(with_commands(robot, quaternion=quaternion))
    names = ", ".join(f"u{place + 3}" for place in range(length))
    assert found == {"suspicious_orientation": f"{names} are of unit norm in every row."}


def test_a_column_times_a_constant_is_a_copy(robot: dict[str, Samples]) -> None:
    found = codes(with_commands(robot, other=lambda rows: -2.5 * rows.commands[:, 0]))
    assert found["suspicious_copies"] == "u3 is -2.5 times u1."


def test_desired_and_measured_values_of_one_quantity_are_a_pair(robot: dict[str, Samples]) -> None:
    rng = np.random.default_rng(0)
    found = codes(with_commands(robot, read=lambda rows: rows.commands[:, 1] + 0.01 * rng.normal(size=len(rows))))
    assert re.fullmatch(r"u2 and u3 differ by 0\.[45]\d% of their range\.", found["suspicious_pairs"])
    tip = codes(with_commands(robot, wish=lambda rows: rows.positions[:, 5] + 0.2 * rng.normal(size=len(rows))))
    assert "u3 and m2_z" in tip["suspicious_pairs"]


def test_a_counter_among_the_commands_is_named(robot: dict[str, Samples]) -> None:
    numbers = np.random.default_rng(0).permutation(700)
    starts = iter(np.split(numbers, np.cumsum([len(rows) for rows in robot.values()])[:-1]))
    found = codes(with_commands(robot, number=lambda _: np.sort(next(starts)).astype(float)))
    assert found == {"suspicious_running_number": "u3 grows by 1 from row to row."}


def test_few_rows_say_nothing(robot: dict[str, Samples]) -> None:
    assert "not_measured" in check({name: rows.take(slice(4)) for name, rows in robot.items()}).numbers


CASES = {
    "01_residual_columns.csv": (
        ["dx", "dy", "dz"],
        ["x_pcc", "y_pcc", "z_pcc", "x_real", "y_real", "z_real"],
        "affine",
    ),
    "02_quaternion_q0_q3.csv": (["q0", "q1", "q2", "q3"], ["x", "y", "z"], "orientation"),
    "04_trajectory_with_ID_only.csv": (["ID", "u1", "u2"], ["x", "y", "z"], "running_number"),
}


@pytest.mark.parametrize("file", CASES)
def test_a_case_that_is_read_with_the_wrong_columns_is_suspicious(file: str) -> None:
    commands, positions, kind = CASES[file]
    entry: dict[str, Any] = {"file": file, "position_unit": "mm", "commands": commands, "positions": positions}
    entry |= {"split": {"method": "random"}}
    found = check(table_file.read(HOUSE / "tests" / "cases" / file, dataset="arm", source=entry)).findings
    assert f"suspicious_{kind}" in {finding.code for finding in found}
