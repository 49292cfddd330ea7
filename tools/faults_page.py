"""docs/faults.md: every fault of tests/contract/faults/, what happens, and its test.

python -m tools.faults_page
"""

from __future__ import annotations

from softkin.core.files import write_text
from tests.conftest import HOUSE
from tests.contract.faults import FAULTS

PAGE = HOUSE / "docs" / "faults.md"
PREFACE = """\
# Faults and what happens

Made by `make faults-page` from `tests/contract/faults/`; a test checks that it is up to date and that each test is
there. {count} faults: after each softkin succeeds, or says in one message which file and what to do, and nothing that
was finished is lost. Bad inputs have [a page of their own](bad_inputs.md).
"""


def page() -> str:
    """The text of the page."""
    parts = [PREFACE.format(count=sum(map(len, FAULTS.values())))]
    for heading, faults in FAULTS.items():
        rows = [f"| {fault.what} | {fault.happens} | `tests/{fault.test}` |" for fault in faults]
        parts.append(
            "\n".join([f"## {heading}", "", "| fault | what happens | test |", "| --- | --- | --- |", *rows, ""])
        )
    return "\n".join(parts)


if __name__ == "__main__":
    write_text(PAGE, page())
