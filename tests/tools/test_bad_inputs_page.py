from __future__ import annotations

from pathlib import Path

from tools.bad_inputs_page import PAGE, page


def test_the_page_says_what_softkin_answers(tmp_path: Path) -> None:
    assert PAGE.read_text() == page(tmp_path), "bring it up to date: make bad-inputs-page"
