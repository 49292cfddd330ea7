from __future__ import annotations

import numpy as np

from softkin.core.samples import SUBSETS, Samples
from softkin.data.audit.cleaning import cleaned
from tests.unit.data.audit.conftest import Replace


def test_stuck_and_duplicate_rows_leave_train_and_no_other_subset(robot: dict[str, Samples], changed: Replace) -> None:
    train, test = robot["train"], robot["test"]
    samples = changed("train", [50, 60], positions=train.positions[5])
    samples = changed("train", [80, 81], commands=train.commands[7], positions=train.positions[7], of=samples)
    samples = changed("test", [1], commands=test.commands[0], positions=test.positions[0], of=samples)
    result, removed = cleaned(samples)
    assert removed == {"stuck_rows": 2, "duplicate_rows": 2}
    kept = np.delete(np.arange(392), [50, 60, 80, 81])
    np.testing.assert_array_equal(result["train"].commands, train.commands[kept])
    np.testing.assert_array_equal(result["train"].positions, train.positions[kept])
    assert all(result[subset] is samples[subset] for subset in SUBSETS if subset != "train")


def test_the_other_subsets_do_not_decide(robot: dict[str, Samples], changed: Replace) -> None:
    samples = changed("train", [50, 60], positions=robot["train"].positions[5])
    garbage = {
        name: rows if name == "train" else Samples(0 * rows.commands, 0 * rows.positions)
        for name, rows in samples.items()
    }
    one, other = cleaned(samples), cleaned(garbage)
    assert one[1] == other[1]
    np.testing.assert_array_equal(one[0]["train"].positions, other[0]["train"].positions)


def test_a_clean_robot_keeps_all_its_rows(robot: dict[str, Samples]) -> None:
    result, removed = cleaned(robot)
    assert removed == {"stuck_rows": 0, "duplicate_rows": 0}
    np.testing.assert_array_equal(result["train"].positions, robot["train"].positions)
