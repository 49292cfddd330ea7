from __future__ import annotations

from softkin.core.samples import Samples
from softkin.data.audit.duplicate_rows import check
from tests.unit.data.audit.conftest import Replace


def test_copies_of_earlier_rows_are_counted_per_subset(robot: dict[str, Samples], changed: Replace) -> None:
    train, test = robot["train"], robot["test"]
    samples = changed("train", [300, 301, 302], commands=train.commands[5], positions=train.positions[5])
    samples = changed("test", [40], commands=test.commands[39], positions=test.positions[39], of=samples)
    result = check(samples)
    (finding,) = result.findings
    assert (finding.code, finding.severity) == ("duplicate_rows", "note")
    assert finding.rows == {"train": (300, 301, 302), "test": (40,)}
    assert "4 of 700 rows" in finding.sentence
    assert result.numbers["rows"] == {"train": 3, "validation": 0, "test": 1, "extrapolation": 0}


def test_a_hundredth_of_the_rows_is_a_warning(robot: dict[str, Samples], changed: Replace) -> None:
    train = robot["train"]
    for n_copies, severity in ((6, "note"), (7, "warning")):
        rows = slice(300, 300 + n_copies)
        (finding,) = check(changed("train", rows, commands=train.commands[5], positions=train.positions[5])).findings
        assert finding.severity == severity


def test_a_command_measured_twice_is_no_duplicate(robot: dict[str, Samples], changed: Replace) -> None:
    assert not check(changed("train", [300], commands=robot["train"].commands[5])).findings
    assert not check(changed("train", [300], positions=robot["train"].positions[5])).findings
