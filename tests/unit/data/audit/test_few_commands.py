from __future__ import annotations

import numpy as np

from softkin.core.samples import Samples
from softkin.data.audit.few_commands import check
from tests.unit.data.audit.conftest import Replace


def test_few_commands_in_many_rows_are_a_finding(robot: dict[str, Samples], changed: Replace) -> None:
    few = robot["train"].commands[np.arange(392) % 20]
    result = check(changed("train", slice(None), commands=few))
    (finding,) = result.findings
    assert (finding.code, finding.severity) == ("few_distinct_commands", "warning")
    assert "All 700 rows hold only 328 distinct commands; train has 20 in 392 rows" in finding.sentence


def test_a_repeated_command_here_and_there_is_none_of_it(robot: dict[str, Samples], changed: Replace) -> None:
    result = check(changed("train", slice(0, 190), commands=robot["train"].commands[200]))
    assert not result.findings
    assert result.numbers == {
        "distinct": {"train": 202, "validation": 49, "test": 49, "extrapolation": 210},
        "distinct_in_all_subsets": 510,
    }
