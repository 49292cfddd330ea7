"""docs/bad_inputs.md: every bad input of tests/contract/bad_inputs, and what softkin answers.

python -m tools.bad_inputs_page
"""

from __future__ import annotations

import logging
import tempfile
from pathlib import Path

from softkin.core.files import write_text
from tests.conftest import HOUSE
from tests.contract.bad_inputs import CASES
from tests.contract.bad_inputs.case import answer, message

PAGE = HOUSE / "docs" / "bad_inputs.md"
PREFACE = """\
# Bad inputs and what softkin answers

Made by `make bad-inputs-page` from `tests/contract/bad_inputs`; a test checks that it is up to date. {count} inputs,
each with one message that says where, what and how to fix it; none is accepted, and none gives a traceback. What
concerns the configuration is refused before any job starts, what concerns a file by the first job that reads it.
"""


def page(folder: Path) -> str:
    """The text of the page; the inputs are made in `folder`."""
    parts = [preface()]
    for number, (heading, cases) in enumerate(CASES.items()):
        places = [folder / f"{number}_{place}" for place in range(len(cases))]
        rows = [row(case.what, message(answer(case, place), place)) for case, place in zip(cases, places, strict=True)]
        parts.append("\n".join([f"## {heading}", "", "| input | message |", "| --- | --- |", *rows]) + "\n")
    return "\n".join(parts)


def preface() -> str:
    """What stands above the tables."""
    return PREFACE.format(count=sum(map(len, CASES.values())))


def row(what: str, said: str) -> str:
    """The row of an input: what is wrong with it, and the message that it gets."""
    lines = [f"`` {' '.join(line.split())} ``" for line in said.replace("|", "\\|").splitlines()]
    return f"| {what} | {'<br>'.join(lines)} |"


def main() -> None:
    """Write the page."""
    logging.getLogger("softkin").setLevel(logging.CRITICAL)
    with tempfile.TemporaryDirectory() as folder:
        write_text(PAGE, page(Path(folder).resolve()))


if __name__ == "__main__":
    main()
