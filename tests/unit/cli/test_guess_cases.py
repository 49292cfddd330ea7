"""What is guessed of the files in tests/cases."""

from __future__ import annotations

from typing import Any

import pytest

from softkin.cli.guess_entry import guess_entry
from tests.conftest import HOUSE


@pytest.mark.parametrize(
    ("file", "expected", "said"),
    [
        (
            "01_residual_columns.csv",
            {"commands": ["dl1", "dl2"], "positions": ["x_real", "y_real", "z_real"]}, "dx, dy, dz"),
        ("02_quaternion_q0_q3.csv", {"commands": ["valve1", "valve2"]}, "q0, q1, q2, q3"),
        ("04_trajectory_with_ID_only.csv", {"order": "ID", "split": {"method": "later"}}, "running number"),
        ("05_rpy_and_quaternion_xyz.csv", {"positions": [f"translation_{axis}" for axis in "xyz"]}, "rpy_x"),
        ("07_commands_and_positions.npz", {"commands": ["act_list_1", "act_list_2"]}, "please check"),
        ("13_occluded_marker.csv", {"missing": "drop_rows"}, "missing: "),
        ("14_text_columns.csv", {"commands": ["spool1", "spool2"]}, "action_name"),
        ("17_outputs_y1_y2_y3.csv", {"positions": ["y1", "y2", "y3"], "commands": ["u1", "u2"]}, "please check"),
        ("19_units_row.csv", {"position_unit": "mm"}, "row of units"),
        ("27_struct.mat", {"positions": ["y_1", "y_2", "y_3"], "commands": ["u_1", "u_2"]}, "please check"),
        ("32_planar.csv", {"dimensions": 2, "commands": ["spool1", "spool2"]}, "planar"),
    ],
)  # fmt: skip
def test_the_guess_of_a_recorded_file(file: str, expected: dict[str, Any], said: str) -> None:
    entry, reasons = guess_entry(HOUSE / "tests" / "cases" / file, "Arm", file)
    assert {key: entry.get(key) for key in expected} == expected
    assert any(said in reason for reason in reasons)
