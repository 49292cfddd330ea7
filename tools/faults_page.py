"""docs/faults.md: every fault of tests/contract/faults/, what happens, and its test.

python -m tools.faults_page
"""

from __future__ import annotations

import ast
from functools import cache

from softkin.core.files import write_text
from tests.conftest import HOUSE
from tests.contract.faults import FAULTS

PAGE = HOUSE / "docs" / "faults.md"
PREFACE = """\
# Faults and what happens

Made by `make faults-page` from `tests/contract/faults/`; a test checks that it is up to date and that each test is
there. Those with a star take long: `make campaigns` runs them. {count} faults: after each softkin succeeds, or says in
one message which file and what to do, and nothing that was finished is lost. Bad inputs have
[a page of their own](bad_inputs.md).
"""


@cache
def slow_tests(file: str) -> frozenset[str]:
    """The tests of a file that `make test` leaves out."""
    functions = [
        node for node in ast.parse((HOUSE / "tests" / file).read_text()).body if isinstance(node, ast.FunctionDef)
    ]
    return frozenset(of.name for of in functions if "pytest.mark.slow" in map(ast.unparse, of.decorator_list))


def page() -> str:
    """The text of the page."""
    parts = [PREFACE.format(count=sum(map(len, FAULTS.values())))]
    for heading, faults in FAULTS.items():
        rows = []
        for fault in faults:
            file, name = fault.test.split("::")
            star = " *" if name in slow_tests(file) else ""
            rows.append(f"| {fault.what} | {fault.happens} | `tests/{fault.test}`{star} |")
        parts.append(
            "\n".join([f"## {heading}", "", "| fault | what happens | test |", "| --- | --- | --- |", *rows, ""])
        )
    return "\n".join(parts)


if __name__ == "__main__":
    write_text(PAGE, page())
