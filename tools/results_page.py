"""Write docs/results.md: what a finished run of the default configuration is worth.

    python -m tools.results_page [--results results] [--page docs/results.md]

Tables and numbers come from the run, the text around them from `results_page.md.j2`, which holds no number. What
`make gallery` has written between its marks is kept.
"""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from softkin.core.files import write_text
from tools.finished_run import FinishedRun, page_program
from tools.gallery import BEGIN, END
from tools.results_intervals import intervals_in_domain, intervals_in_extrapolation
from tools.results_points import data, points_in_extrapolation, printed_cells
from tools.results_recorded import robots_in_time

TEMPLATE = Path(__file__).with_name("results_page.md.j2")
SECTIONS = (
    *(data, printed_cells, points_in_extrapolation),
    *(intervals_in_domain, intervals_in_extrapolation, robots_in_time),
)
MAX_WIDTH = 120


def make_results_page(results: Path, page: Path) -> None:
    """Write the page from the run in `results`.

    Raises:
        DataError: the run has not made one of the tables.
    """
    run = FinishedRun(results)
    context = {"gallery": _gallery(page)}
    for section in SECTIONS:
        context |= section(run)
    environment = Environment(loader=FileSystemLoader(TEMPLATE.parent), undefined=StrictUndefined, autoescape=False)
    write_text(page, wrapped(environment.get_template(TEMPLATE.name).render(context)) + "\n")


def _gallery(page: Path) -> str:
    """The gallery of the page as it stands, or its empty place."""
    text = page.read_text(encoding="utf-8") if page.is_file() else ""
    written = re.search(f"{re.escape(BEGIN)}.*?{re.escape(END)}", text, re.DOTALL)
    return written[0] if written else f"{BEGIN}\n{END}"


def wrapped(text: str) -> str:
    """Markdown with its paragraphs and list items filled to lines of `MAX_WIDTH`; tables and headings as they are."""
    blocks = []
    for block in re.split(r"\n{2,}", text.strip()):
        if block.startswith(("#", "|", "<!--")):
            blocks.append(block)
            continue
        items = re.split(r"\n(?=- )", block)
        indents = ["  " if item.startswith("- ") else "" for item in items]
        blocks.append("\n".join(_filled(item, indent) for item, indent in zip(items, indents, strict=True)))
    return "\n\n".join(blocks)


def _filled(text: str, indent: str) -> str:
    words = " ".join(text.split())
    return textwrap.fill(words, MAX_WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def main() -> int:
    """Print the error, if any; return the exit status."""
    return page_program(make_results_page, Path("docs") / "results.md", __doc__)


if __name__ == "__main__":
    sys.exit(main())
