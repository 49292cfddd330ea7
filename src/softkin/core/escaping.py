"""Text of other people (titles, notes, names of columns) within Markdown, LaTeX, CSV and figures: it stays text there.

HTML needs nothing here: the page's templates escape all that they are given.
"""

from __future__ import annotations

import re
import unicodedata

import pandas as pd

#: What begins markup in Markdown. Underscores within words and `<` before numbers do not.
_MARKDOWN = re.compile(r"[\\`*\[\]|]|<(?=[a-zA-Z/!?])|&(?=#|\w+;)|(?<!\w)_|_(?!\w)")
#: What begins a heading, a quotation or a list at the start of a line.
_BLOCK = re.compile(r"[#>]|[+-](?: |$)")
_ENTITIES = {"|": "&#124;", "<": "&lt;", "&": "&amp;"}
_LATEX = {
    **{character: f"\\{character}" for character in "&%_#${}"},
    **{character: f"${character}$" for character in "<>"},
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
}
#: With one of these a cell begins that spreadsheets take for a formula.
_FORMULA = ("=", "+", "-", "@")


def one_line(text: str) -> str:
    """The `text` in one line, without control characters: those move the cursor of a terminal, or turn text around."""
    visible = (" " if c.isspace() else "" if unicodedata.category(c) in ("Cc", "Cf") else c for c in text)
    return " ".join("".join(visible).split())


def markdown_text(text: str) -> str:
    """The `text` as text of a line, or of a cell, in Markdown: no link, no HTML, no code, no column of its own."""
    line = _MARKDOWN.sub(lambda found: _ENTITIES.get(found[0], f"\\{found[0]}"), one_line(text))
    return f"\\{line}" if _BLOCK.match(line) else line


def latex_text(text: str) -> str:
    """The `text` as text in LaTeX: no command, no mathematics, no comment."""
    return "".join(_LATEX.get(character, character) for character in one_line(text))


def csv_text(text: str) -> str:
    """The `text` of a cell of a CSV: with an apostrophe before it where a spreadsheet would take it for a formula."""
    begins = text.lstrip()[:1]
    return f"'{text}" if begins in _FORMULA and begins and not _is_number(text) else text


def csv_frame(frame: pd.DataFrame) -> pd.DataFrame:
    """The table with each cell and heading of text as `csv_text` has it."""
    texts = frame.select_dtypes(exclude=["number", "bool"]).columns
    safe = {name: frame[name].map(lambda cell: csv_text(cell) if isinstance(cell, str) else cell) for name in texts}
    return frame.assign(**safe).rename(columns=csv_text)


def figure_text(text: str) -> str:
    """The `text` as text in a figure of matplotlib, which takes what stands between two dollars for mathematics."""
    return "\n".join(one_line(line) for line in text.splitlines()).replace("$", r"\$")


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
