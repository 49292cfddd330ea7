from __future__ import annotations

import numpy as np

from softkin.core.samples import Samples
from softkin.data.audit.copied_commands import check
from softkin.data.audit.findings import LEAK, WARNING
from tests.unit.data.audit.conftest import Replace


def test_copies_of_train_commands_are_a_leak(robot: dict[str, Samples], changed: Replace) -> None:
    result = check(changed("test", slice(10, 20), commands=robot["train"].commands[:10]))
    (finding,) = result.findings
    assert (finding.code, finding.severity, finding.subsets) == ("copied_commands", LEAK, ("test",))
    assert finding.rows["test"] == tuple(range(10, 20))
    assert "10 of 49 rows of test (20.4%)" in finding.sentence
    assert "training error" in finding.consequence
    assert result.numbers["test"] == {"rows": 10, "share": 10 / 49}


def test_fewer_copies_than_a_hundredth_are_a_warning(robot: dict[str, Samples], changed: Replace) -> None:
    (finding,) = check(changed("extrapolation", [5], commands=robot["train"].commands[7])).findings
    assert (finding.severity, finding.subsets, finding.rows["extrapolation"]) == (WARNING, ("extrapolation",), (5,))


def test_a_command_next_to_one_of_train_is_no_copy(robot: dict[str, Samples], changed: Replace) -> None:
    assert not check(robot).findings
    assert not check(changed("test", [0], commands=np.nextafter(robot["train"].commands[0], 2))).findings


def test_equal_commands_within_train_are_no_leak(robot: dict[str, Samples], changed: Replace) -> None:
    assert not check(changed("train", slice(0, 50), commands=robot["train"].commands[100])).findings
