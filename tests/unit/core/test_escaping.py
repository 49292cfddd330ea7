from __future__ import annotations

import io
import re
from html.parser import HTMLParser

import matplotlib.figure
import pandas as pd
import pytest
from markdown import markdown  # type: ignore[import-untyped]

from softkin.core.escaping import csv_frame, csv_text, figure_text, latex_text, markdown_text, one_line
from tests.nasty import NASTY


class Html(HTMLParser):
    """Tags and text of a page."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.text = ""
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        del attrs
        self.tags.append(tag)

    def handle_data(self, data: str) -> None:
        self.text += data


@pytest.mark.parametrize(
    "text", [NASTY, NASTY[::-1], "# a", "> a", "- a", "+ a", "[a]: javascript:x", "<b>", "**a**", "_a_"]
)
def test_in_markdown_text_stays_text(text: str) -> None:
    """As a line, within a line, and as a cell."""
    for before, after in (("", ""), ("Note: ", " end")):
        html = Html(markdown(f"{before}{markdown_text(text)}{after}", extensions=["tables"]))
        assert html.tags == ["p"]
        assert html.text.strip() == f"{before}{one_line(text)}{after}"
    html = Html(markdown(f"| a | b |\n| --- | --- |\n| {markdown_text(text)} | 1 |", extensions=["tables"]))
    assert html.tags == ["table", "thead", "tr", "th", "th", "tbody", "tr", "td", "td"]


@pytest.mark.parametrize(
    "text", ["FINGER (real tendon finger)", "max_rows_per_subset", "-1.5 to 12", "<0.001", "R&D", "a < b"]
)
def test_plain_text_is_left_alone_in_markdown(text: str) -> None:
    assert markdown_text(text) == text


def test_in_latex_text_stays_text() -> None:
    latex = latex_text(NASTY)
    for command in re.findall(r"\\([a-zA-Z]+)", latex):
        assert command in ("textbackslash", "textasciitilde", "textasciicircum")
    assert latex_text("50 % of a_b & {c} $d$ #1 ~ ^ \\x <y>") == (
        r"50 \% of a\_b \& \{c\} \$d\$ \#1 \textasciitilde{} \textasciicircum{} \textbackslash{}x $<$y$>$"
    )
    assert "\n" not in latex


@pytest.mark.parametrize("text", ["=1+1", "+1+1", "-1+1", "@SUM(A1)", " =1", "\t=1", "\r=1", NASTY])
def test_in_a_spreadsheet_text_is_no_formula(text: str) -> None:
    assert csv_text(text) == f"'{text}"


@pytest.mark.parametrize("text", ["-1.5", "+2", "-inf", "", "FINGER", "a=b", "–"])
def test_numbers_and_plain_text_are_left_alone_in_a_csv(text: str) -> None:
    assert csv_text(text) == text


def test_a_table_keeps_its_numbers_and_what_is_missing() -> None:
    frame = pd.DataFrame({"note": ["=1+1", None], "value": [-1.5, 2.0], "=a": ["x", "-y"], "is": [True, False]})
    written = csv_frame(frame).to_csv(index=False)
    assert written == "note,value,'=a,is\n'=1+1,-1.5,x,True\n,2.0,'-y,False\n"


def test_in_a_figure_dollars_are_dollars() -> None:
    figure = matplotlib.figure.Figure()
    figure.suptitle(figure_text(NASTY))
    figure.savefig(io.BytesIO(), format="svg")
    assert figure_text("a $b$\nc\x1b") == "a \\$b\\$\nc"


def test_a_terminal_gets_no_sequences() -> None:
    assert one_line("a\x1b[31m\u202eb\r\n\tc\x9b") == "a[31mb c"
