from __future__ import annotations

from typing import Any

import numpy as np

from softkin.core.samples import Samples
from softkin.data.audit.copied_commands import check
from softkin.data.audit.findings import LEAK, NOTE, WARNING
from softkin.data.readers import table_file
from tests.conftest import HOUSE
from tests.unit.data.audit.conftest import Replace


def test_copies_of_train_commands_are_a_leak(robot: dict[str, Samples], changed: Replace) -> None:
    first = robot["train"].take(slice(10))
    result = check(changed("test", slice(10, 20), commands=first.commands, positions=first.positions))
    (finding,) = result.findings
    assert (finding.code, finding.severity, finding.subsets) == ("copied_commands", LEAK, ("test",))
    assert finding.rows["test"] == tuple(range(10, 20))
    assert "10 of 49 rows of test (20.4%)" in finding.sentence
    assert "training error" in finding.consequence
    assert result.numbers["test"] == {"rows": 10, "share": 10 / 49, "poses_repeated": 10}


def test_fewer_copies_than_a_hundredth_are_a_warning(robot: dict[str, Samples], changed: Replace) -> None:
    row = robot["train"].take([7])  # type: ignore[arg-type]
    (finding,) = check(changed("extrapolation", [5], commands=row.commands, positions=row.positions)).findings
    assert finding.code == "copied_commands"
    assert (finding.severity, finding.subsets, finding.rows["extrapolation"]) == (WARNING, ("extrapolation",), (5,))


def test_a_command_next_to_one_of_train_is_no_copy(robot: dict[str, Samples], changed: Replace) -> None:
    assert not check(robot).findings
    assert not check(changed("test", [0], commands=np.nextafter(robot["train"].commands[0], 2))).findings


def test_equal_commands_within_train_are_no_leak(robot: dict[str, Samples], changed: Replace) -> None:
    assert not check(changed("train", slice(0, 50), commands=robot["train"].commands[100])).findings


def test_a_command_of_train_that_is_measured_anew_is_no_leak(robot: dict[str, Samples], changed: Replace) -> None:
    first = robot["train"].take(slice(10))
    off = first.positions + np.tile([3.0, 0.0, 4.0], 2)
    result = check(changed("test", slice(10, 20), commands=first.commands, positions=off))
    (finding,) = result.findings
    assert (finding.code, finding.severity, finding.subsets) == ("repeated_commands", WARNING, ("test",))
    assert finding.rows["test"] == tuple(range(10, 20))
    assert "of test" in finding.sentence
    assert "by 5 mm" in finding.sentence
    assert result.numbers["test"]["poses_repeated"] == 0
    (single,) = check(changed("extrapolation", [5], commands=robot["train"].commands[7])).findings
    assert (single.severity, single.subsets) == (NOTE, ("extrapolation",))


def test_case_33_repeated_commands_in_a_split_by_time_are_no_leak() -> None:
    entry: dict[str, Any] = {
        "file": "33",
        "position_unit": "mm",
        "commands": ["u1", "u2"],
        "positions": ["x", "y", "z"],
    }
    entry |= {"split": {"method": "time", "column": "time"}, "order": "time"}
    path = HOUSE / "tests" / "cases" / "33_repeated_command_by_time.csv"
    findings = check(table_file.read(path, dataset="arm", source=entry)).findings
    assert {finding.code for finding in findings} == {"repeated_commands"}
    assert all(finding.subsets[0] in finding.sentence for finding in findings)
