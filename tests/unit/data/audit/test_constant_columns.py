from __future__ import annotations

import numpy as np

from softkin.core.samples import Samples
from softkin.data.audit.constant_columns import check
from tests.unit.data.audit.conftest import Replace


def test_a_marker_that_never_moves_is_named(robot: dict[str, Samples], changed: Replace) -> None:
    positions = robot["train"].positions.copy()
    positions[:, :3] = [1.0, 2.0, 0.0]
    positions[:, 2] = np.linspace(0, 1e-30, len(positions))
    positions[:, 4] = 7.0
    (finding,) = check(changed("train", slice(None), positions=positions)).findings
    assert finding.code == "constant_coordinates"
    assert "4 of 6 coordinates" in finding.sentence
    assert "m1_x, m1_y, m1_z, m2_y (marker 1 as a whole)" in finding.sentence


def test_a_command_that_is_never_varied_is_named(robot: dict[str, Samples], changed: Replace) -> None:
    commands = robot["train"].commands.copy()
    commands[:, 1] = 0.5
    result = check(changed("train", slice(None), commands=commands))
    (finding,) = result.findings
    assert (finding.code, result.numbers["commands"]) == ("constant_commands", ["u2"])


def test_a_coordinate_that_moves_by_a_thousandth_of_a_millimetre_moves(
    robot: dict[str, Samples], changed: Replace
) -> None:
    positions = robot["train"].positions.copy()
    positions[:, 0] = np.linspace(10, 10.001, len(positions))
    result = check(changed("train", slice(None), positions=positions))
    assert not result.findings
    assert result.numbers == {"coordinates": [], "commands": []}


def test_the_third_coordinate_of_a_planar_robot_is_no_finding(robot: dict[str, Samples], changed: Replace) -> None:
    samples = robot
    for name, rows in robot.items():
        flat = rows.positions * np.tile([1.0, 1.0, 0.0], 2)
        samples = changed(name, slice(None), positions=flat, of=samples)
    assert check(samples).findings == ()
