"""No bad input is accepted, and none gives a traceback: each has one message for a person, with place and fix."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.contract.bad_inputs import CASES
from tests.contract.bad_inputs.case import BadInput, answer, message
from tools.bad_inputs_page import PAGE, row

ALL = [(heading, case) for heading, cases in CASES.items() for case in cases]


def test_there_are_many_and_each_is_another() -> None:
    assert len(ALL) >= 120
    assert len({(heading, case.what) for heading, case in ALL}) == len(ALL)


@pytest.mark.parametrize("case", [pytest.param(case, id=f"{heading}: {case.what}") for heading, case in ALL])
def test_a_bad_input_has_one_message_with_place_and_fix(case: BadInput, tmp_path: Path) -> None:
    error = answer(case, tmp_path)
    for part in case.says:
        assert part in str(error)
    assert error.where
    assert error.fix
    problems = error.what.splitlines()
    assert len(problems) == (2 if error.where.startswith("configuration") else 1), "one mistake, one line"
    assert max(map(len, problems)) <= 320
    assert "Traceback" not in str(error)
    line = row(case.what, message(error, tmp_path))
    assert line in PAGE.read_text().splitlines(), "bring the page up to date: make bad-inputs-page"
