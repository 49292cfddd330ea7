"""The whole page: it is self-contained, marks what leaks wherever it stands, and says what is chosen and deployed."""

from __future__ import annotations

import re
import subprocess
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pandas as pd
import pytest

from softkin.core.errors import ConfigError
from softkin.core.files import write_json
from softkin.reporting.page import build as build_module
from tests.unit.reporting.page.conftest import NOTE, Results

#: The tables of the page and the CSV files beside it; those without one carry their CSV.
FILES = {
    "data": "",
    "points": "tables/point_metrics.csv",
    "choice": "tables/interval_choice.csv",
    "intervals": "tables/interval_metrics.csv",
    "searched": "tables/searched_runs.csv",
    "spaces": "tables/target_spaces.csv",
    "extrapolation": "tables/extrapolation_intervals.csv",
    "best": "tables/published_columns.csv",
    "cells": "tables/published_comparison.csv",
    "published-intervals": "tables/published_intervals.csv",
    "slowest": "",
}


class Addresses(HTMLParser):
    """Every address that the page names in an attribute, of links and of what it would load."""

    def __init__(self, page: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.feed(page.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        addresses = [str(value) for name, value in attrs if name in ("src", "href", "srcset", "action", "data")]
        (self.links if tag == "a" else self.loaded).extend(addresses)


def grids(page: Path) -> dict[str, str]:
    """The HTML of each table with what stands above it, by name."""
    return dict(re.findall(r'data-grid id="([\w-]+)-table">(.*?)</table>', page.read_text(encoding="utf-8"), re.DOTALL))


def test_the_page_loads_nothing_and_links_only_to_files_beside_it(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    addresses = Addresses(page)
    assert len(addresses.loaded) > 6
    assert [address for address in addresses.loaded if not address.startswith("data:")] == []
    assert not re.search(r"url\(|@import|https?://", text)
    targets = {link[1:] for link in addresses.links if link.startswith("#")}
    assert len(targets) == 10
    assert all(f'id="{target}"' in text for target in targets)
    files = [link for link in addresses.links if not link.startswith(("#", "data:"))]
    assert all((page.parent / file).is_file() for file in files)


def test_each_table_links_to_its_csv(page: Path) -> None:
    shown = grids(page)
    assert set(shown) == set(FILES)
    for name, file in FILES.items():
        if file:
            assert f'<a href="{file}">' in shown[name]
        else:
            assert f'download="{name}.csv"' in shown[name]
            assert 'href="data:text/csv' in shown[name]


def test_each_figure_has_a_caption_and_links_to_its_file(page: Path) -> None:
    captions = re.findall(r"<figcaption><b>(.*?)\.</b> (.*?) <a href", page.read_text(encoding="utf-8"))
    assert len(captions) == 6
    assert {caption for title, caption in captions if title.startswith("Intervals")} == {"How to read it."}
    assert all(caption for _, caption in captions)


def test_it_says_what_was_run(page: Path, results: Results) -> None:
    text = page.read_text(encoding="utf-8")
    folder = Path(results.arguments["citation"]).parent
    head = subprocess.run(["git", "-C", str(folder), "rev-parse", "HEAD"], capture_output=True, text=True, check=True)
    assert text.count(head.stdout.strip()) == 2  # what was run, and how to run it again
    for part in (
        "campaign made-up",
        "ab" * 32,
        "scikit-learn",
        "2 min 31 s in 2 measured jobs",
        "The authors. softkin",
        "Someone (2023). Data.",
        "seed: 7",
    ):
        assert part in text


def test_what_is_private_stays_out(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert "secret" not in text
    assert "/private/place" not in text


def test_markup_in_titles_is_text(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert "ARM &lt;made up&gt;" in text
    assert "<made up>" not in text


def test_the_headline_names_model_error_and_interval(page: Path) -> None:
    arm, finger = re.findall(r'<article class="robot">.*?</article>', page.read_text(encoding="utf-8"), re.DOTALL)
    parts = ("Gaussian process, tuned", "mean error, test", "Linear regression, 1.25 times", "below a nanometre")
    for part in (*parts, "1 of 2", "System around Gaussian process, tuned"):
        assert part in arm
    assert 'class="badge chosen"' in arm
    assert arm.count('class="badge deployed"') == 2  # the model and the interval
    assert "surrounds no point model" not in arm
    assert 'class="badge chosen"' not in finger
    assert "Chosen is CQR (Gradient boosting, tuned)" in finger
    assert "surrounds no point model" in finger


def test_leaks_cuts_and_stand_ins_stand_wherever_their_numbers_do(page: Path) -> None:
    shown = grids(page)
    for name in set(FILES) - {"slowest"}:
        rows = re.findall(r"<tr><td>(.*?)\n", shown[name])
        assert rows, name
        for row in rows:
            is_test = "<td>test" in row or name in ("data", "choice", "published-intervals", "searched")
            assert ('class="badge leak"' in row) == (row.startswith("arm") and is_test), (name, row)
            for badge in ("rows-left-out", "stand-in"):
                assert (f'class="badge {badge}"' in row) == row.startswith("finger"), (name, row)
    assert page.read_text(encoding="utf-8").count("All rows stand in train. So what. " + NOTE) >= 6


def test_without_a_leak_in_the_data_card_a_note_is_a_caution(results: Results, tmp_path: Path) -> None:
    robots = results.arguments["robots"]
    card = tmp_path / "data_card.json"
    write_json(card, {"title": "ARM", "worst_severity": None, "findings": [], "subsets": {}})
    sound = robots | {"arm": replace(robots["arm"], data_card=card)}
    text = results.build("sound.html", robots=sound).read_text(encoding="utf-8")
    assert 'class="badge caution"' in text
    assert 'class="badge leak"' not in text
    assert NOTE in text
    assert "The audit has no finding." in text


def test_a_caution_of_the_configuration_stands_at_the_top(results: Results, page: Path) -> None:
    config = results.arguments["config"] | {"caution": "Few trials & few <models>."}
    text = results.build("cautious.html", config=config).read_text(encoding="utf-8")
    notice = '<p class="notice"><b>CAUTION</b> Few trials &amp; few &lt;models&gt;.</p>'
    assert notice in text[: text.index("<h1>")]
    assert 'class="notice"' not in page.read_text(encoding="utf-8")


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
    with pytest.raises(ConfigError, match=r"would have .* MB") as error:
        results.build("large.html")
    assert str(error.value.where).endswith("large.html")
    assert "fewer datasets" in str(error.value.fix)
    assert not (results.folder / "large.html").exists()


def test_the_whole_data_card_stands_in_the_page_and_its_markup_is_text(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    card = re.search(r'<details class="whole-card">.*?</details>', text, re.DOTALL)
    assert card
    assert "<h5>The rows</h5>" in card[0]
    assert "<td>40</td>" in card[0]
    assert "rows &lt;b&gt;" in card[0]
    assert "Card of ARM" not in text
