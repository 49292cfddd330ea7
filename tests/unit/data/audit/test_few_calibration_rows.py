from __future__ import annotations

import pytest

from softkin.core.samples import ROWS_FOR_95_PERCENT, Samples
from softkin.data.audit.few_calibration_rows import USUAL_LEVELS, check
from softkin.uncertainty.conformal import conformal_rank


@pytest.mark.parametrize("n_rows", [1, 4, 5, 8, 9, 18, 19, 60])
def test_the_levels_that_are_named_are_those_without_a_finite_interval(robot: dict[str, Samples], n_rows: int) -> None:
    validation = robot["validation"]
    few = Samples(validation.commands[:n_rows], validation.positions[:n_rows])
    result = check(robot | {"validation": few})
    lost = [level for level in USUAL_LEVELS if conformal_rank(len(few), level) is None]
    if len(few) >= ROWS_FOR_95_PERCENT:
        assert not result.findings
        assert set(lost) <= {0.99}
        return
    (finding,) = result.findings
    assert [f"{100 * level:g} %" in finding.sentence for level in USUAL_LEVELS] == [
        level in lost for level in USUAL_LEVELS
    ]
