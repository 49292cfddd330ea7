"""docs/bad_inputs.md. That each of its messages is the one that softkin gives is tested with the inputs:
tests/contract/test_bad_inputs.py.
"""

from __future__ import annotations

from tests.contract.bad_inputs import CASES
from tools.bad_inputs_page import PAGE, preface, row


def test_the_page_has_every_input_once_below_its_heading() -> None:
    text = PAGE.read_text()
    assert text.startswith(preface())
    expected = [line for heading, cases in CASES.items() for line in (f"## {heading}", *(case.what for case in cases))]
    found = [line.split(" | ")[0].removeprefix("| ") for line in text.splitlines() if line.startswith(("## ", "| "))]
    assert [line for line in found if line not in ("input", "---")] == expected


def test_a_row_escapes_what_would_end_its_cell() -> None:
    assert row("a header", "arm.csv: no column a|b\n  fix: name  it") == (
        r"| a header | `` arm.csv: no column a\|b ``<br>`` fix: name it `` |"
    )
