from __future__ import annotations

from pathlib import Path

import pytest

from softkin.reporting.page.cards import card_page

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
