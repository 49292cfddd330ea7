from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from softkin.core.samples import VALIDATION, Samples
from softkin.data.audit.few_calibration_blocks import check
from softkin.data.readers import table_file
from tests.conftest import HOUSE


@pytest.mark.parametrize(("n_blocks", "n_findings"), [(1, 1), (8, 1), (9, 0)])
def test_fewer_than_nine_blocks_are_a_finding(robot: dict[str, Samples], n_blocks: int, n_findings: int) -> None:
    validation = robot[VALIDATION]
    block = np.arange(len(validation)) % n_blocks
    result = check({**robot, VALIDATION: replace(validation, block=block)})
    assert len(result.findings) == n_findings
    assert result.numbers["calibration_blocks"] == n_blocks
    assert result.numbers["highest_level"] == (n_blocks / (n_blocks + 1) if n_blocks > 1 else 0)


def test_rows_that_were_split_one_by_one_are_no_blocks(robot: dict[str, Samples]) -> None:
    assert check(robot).findings == ()


@pytest.mark.parametrize(("n_blocks", "few"), [(100, False), (20, True)])
def test_case_31_a_split_by_time_promises_per_block_or_says_that_it_does_not(n_blocks: int, few: bool) -> None:
    markers = [f"SA-{place}-{axis}" for place in ("base", "low", "up") for axis in "XYZ"]
    entry: dict[str, Any] = {"file": "31", "position_unit": "m", "commands": ["act_1", "act_2"], "positions": markers}
    entry |= {"split": {"method": "time", "column": "Timestamp", "blocks": n_blocks}, "order": "Timestamp"}
    (path,) = (HOUSE / "tests" / "cases").glob("31_*.csv")
    samples = table_file.read(path, dataset="arm", source=entry)
    assert bool(check(samples).findings) == few
    if few:
        assert "4 blocks" in check(samples).findings[0].sentence
