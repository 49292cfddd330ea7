"""What the page says."""

from __future__ import annotations

import re
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import pandas as pd
import pytest

from softkin.core.errors import SoftkinError
from softkin.reporting.page import build as build_module
from tests.unit.reporting.page.conftest import NOTE, Results


class Outside(HTMLParser):
    """Every address that the page names in an attribute."""

    def __init__(self) -> None:
        super().__init__()
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:  # noqa: ARG002
        self.addresses += [str(value) for name, value in attrs if name in ("src", "href", "srcset", "action", "data")]


def test_the_page_is_self_contained(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    outside = Outside()
    outside.feed(text)
    assert len(outside.addresses) > 10
    assert [address for address in outside.addresses if not address.startswith(("data:", "#"))] == []
    assert not re.search(r"url\(|@import|https?://", text)
    targets = {address[1:] for address in outside.addresses if address.startswith("#")}
    assert all(f'id="{target}"' in text for target in targets)


def test_it_says_what_was_run(page: Path, results: Results) -> None:
    text = page.read_text(encoding="utf-8")
    house = Path(results.arguments["citation"]).parent
    head = subprocess.run(["git", "-C", str(house), "rev-parse", "HEAD"], capture_output=True, text=True, check=True)
    assert text.count(head.stdout.strip()) == 2  # what was run, and how to run it again
    for part in (
        "campaign made-up",
        "ab" * 32,
        "scikit-learn",
        "2 min 31 s in 2 measured jobs",
        "The authors. softkin",
    ):
        assert part in text
    assert "Someone (2023). Data." in text
    assert "seed: 7" in text


def test_what_is_private_stays_out(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert "secret" not in text
    assert "/private/place" not in text


def test_markup_in_titles_is_text(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert "ARM &lt;made up&gt;" in text
    assert "<made up>" not in text


def test_the_headline_names_model_error_and_interval(page: Path) -> None:
    card = re.search(r'<article class="robot">.*?</article>', page.read_text(encoding="utf-8"), re.DOTALL)
    assert card
    for part in ("Gaussian process", "mean error, test", "Linear regression, 1.25 times", "2.00 × 10⁻⁷ mm", "1 of 2"):
        assert part in card[0]
    assert "System around Gaussian process, tuned" in card[0]


#: The tables of what holds outside train.
OUTSIDE = ("searched", "spaces", "outside")


def test_leaks_cuts_and_stand_ins_stand_wherever_their_numbers_do(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    grids = dict(re.findall(r'data-grid id="([\w-]+)-table">(.*?)</table>', text, re.DOTALL))
    assert set(grids) == {
        "data",
        "points",
        "choice",
        "intervals",
        "best",
        "cells",
        "published-intervals",
        "slowest",
        *OUTSIDE,
    }
    for name in set(grids) - {"slowest"}:
        rows = re.findall(r"<tr><td>(.*?)\n", grids[name])
        assert rows, name
        for row in rows:
            is_test = "<td>test" in row or name in ("data", "choice", "published-intervals", "searched")
            assert ('class="badge leak"' in row) == (row.startswith("arm") and is_test), (name, row)
            for badge in ("rows-left-out", "stand-in"):
                assert (f'class="badge {badge}"' in row) == row.startswith("finger"), (name, row)
    assert text.count("All rows stand in train. So what. " + NOTE) >= 6


def test_without_a_data_card_a_note_is_a_caution(results: Results) -> None:
    text = results.build("no_card.html", data_cards={}).read_text(encoding="utf-8")
    assert 'class="badge caution"' in text
    assert 'class="badge leak"' not in text
    assert NOTE in text
    assert "Data cards" not in text


def test_untuned_and_uncompared_results_make_a_page_too(results: Results, tmp_path: Path) -> None:
    tables = []
    for path in results.arguments["tables"]:
        if path.stem in ("selection", "searched_runs", "published_columns"):
            continue
        tables.append(tmp_path / path.name)
        frame = pd.read_csv(path)
        if path.stem.startswith("published"):
            frame = frame.head(0) if path.stem == "published_comparison" else pd.DataFrame()
        frame.to_csv(tables[-1], index=False)
    text = results.build("untuned.html", tables=tables).read_text(encoding="utf-8")
    assert "No model was chosen: nothing was tuned." in text
    assert "no table on the robots of this run" in text


def test_a_page_too_large_to_send_is_refused(results: Results, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(build_module, "MAX_BYTES", 1000)
    with pytest.raises(SoftkinError, match=r"large\.html.*would have .* MB(.|\n)*mend"):
        results.build("large.html")
    assert not (results.folder / "large.html").exists()


def test_the_whole_data_card_stands_in_the_page_and_its_markup_is_text(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    card = re.search(r'<details class="whole-card">.*?</details>', text, re.DOTALL)
    assert card
    assert "<h5>The rows</h5>" in card[0]
    assert "<td>40</td>" in card[0]
    assert "rows &lt;b&gt;" in card[0]
    assert "Card of ARM" not in text
