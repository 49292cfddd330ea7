"""Words that softkin has given up and paths of a machine stand nowhere; prose in Markdown has lines of at most 120
characters.
"""

from __future__ import annotations

import re
from pathlib import Path

from tests.conftest import HOUSE

#: Each has a term of the field in docs/glossary.md in its place.
GIVEN_UP = ["evidence", "learner", r"mend\b", "trembl", "believed", "out there", "law of growth", "has no say"]
PLACES = [
    "src",
    "workflow",
    "docs",
    "tools",
    "benchmarks",
    "config",
    "templates",
    "tests",
    "*.md",
    "Makefile",
    "Snakefile",
]
KINDS = {".py", ".smk", ".md", ".yaml", ".rst", ".j2", ".js", ".css", ""}
FILES = [path for place in PLACES for top in HOUSE.glob(place) for path in [top, *top.rglob("*")] if path.is_file()]


def test_words_that_were_given_up_stand_nowhere() -> None:
    word = re.compile("|".join(GIVEN_UP), re.IGNORECASE)
    texts = {path: path.read_text() for path in FILES if path.suffix in KINDS and path != Path(__file__)}
    lines = [(path, line) for path, text in texts.items() for line in text.splitlines()]
    assert [f"{path}: {line.strip()}" for path, line in lines if word.search(line)] == []


def test_paths_of_a_machine_stand_nowhere() -> None:
    place = re.compile(r"(?<![\w.])/(tmp|home|root|work|Users)/\w")
    texts = {path: path.read_text() for path in FILES if path.suffix in KINDS and path != Path(__file__)}
    assert [str(path) for path, text in texts.items() if place.search(text)] == []


def test_prose_in_markdown_has_short_lines() -> None:
    """A row of a table, and a line with a link, may be longer."""
    lines = [(path, line) for path in FILES if path.suffix == ".md" for line in path.read_text().splitlines()]
    assert [place for place in lines if len(place[1]) > 120 and not re.search(r"^\||\]\(|http", place[1])] == []
