from __future__ import annotations

import re
from html import unescape
from pathlib import Path

import pytest

from softkin.core.escaping import markdown_text, one_line
from softkin.reporting.page.cards import card_page
from tests.nasty import NASTY

CARD = """# Data card: ARM & <b>more</b>

`arm`. **Sound.**

## What was found

- **warning**, `stuck_poses`: two rows & <script>.
  - train, 2 rows: 1, 2

| subset | rows |
| --- | --- |
| test | 40 |
"""


@pytest.fixture
def html(tmp_path: Path) -> str:
    (tmp_path / "data_card.md").write_text(CARD, encoding="utf-8")
    return card_page(tmp_path / "data_card.md")


def test_the_title_is_left_out_and_headings_lie_below_those_of_the_page(html: str) -> None:
    assert "Data card" not in html
    assert "<h5>What was found</h5>" in html
    assert "<h2>" not in html


def test_markdown_is_laid_out_and_markup_is_text(html: str) -> None:
    assert "<strong>Sound.</strong>" in html
    assert "two rows &amp; &lt;script&gt;." in html
    assert "<script>" not in html


def test_the_rows_of_a_finding_are_a_list_within_it(html: str) -> None:
    outer, inner = html.index("stuck_poses"), html.index("train, 2 rows")
    assert "<ul>" in html[outer:inner]


def test_a_table_scrolls_in_a_box_that_the_keyboard_reaches(html: str) -> None:
    assert '<div class="scroll" tabindex="0"' in html
    assert html.count("<table>") == html.count("</table></div>") == 1


@pytest.mark.parametrize(
    "text", [NASTY, "[a](javascript:alert(1))", "![a](x)", "<javascript:alert(1)>", "[a]\n\n[a]: javascript:x"]
)
def test_a_card_has_no_link_even_if_its_text_was_not_escaped(tmp_path: Path, text: str) -> None:
    (tmp_path / "data_card.md").write_text(f"# Data card\n\n{text}\n", encoding="utf-8")
    html = card_page(tmp_path / "data_card.md")
    assert not re.search(r"<(a|img|script|iframe)\b", html)


def test_what_is_escaped_in_a_card_is_read_as_it_was(tmp_path: Path) -> None:
    (tmp_path / "data_card.md").write_text(f"# Data card\n\n{markdown_text(NASTY)}\n", encoding="utf-8")
    text = re.sub(r"<.*?>", "", card_page(tmp_path / "data_card.md"))
    assert unescape(text).strip() == one_line(NASTY)
