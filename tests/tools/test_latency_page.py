"""The page of latencies, from what the benchmark printed."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from tools.latency_page import PAGE, main, page, read

ROWS = [
    {"robot": "arm", "way": "model", "where": "inside", "median_ms": 0.25, "p99_ms": 0.5},
    {"robot": "arm", "way": "model", "where": "many rows", "rows": 9, "ms": 30.0, "bare_ms": 20.0},
    {"robot": "arm", "way": "C header", "where": "inside", "median_ms": 0.01},
    {"robot": "arm", "way": "C header", "where": "difference", "mm": 2e-13, "outside_differs": 0},
]


def test_a_line_for_each_way_to_ask() -> None:
    text = page(read(map(json.dumps, ROWS)))
    assert "| arm | model | 0.2500, 0.5000 |  |  |  |  |  |  |" in text
    assert "| arm | C header | 0.0100 |  |  |  |  |  | 2e-13 |" in text
    assert "| arm | 9 | 20 | 30 | 1.50 |" in text
    assert "on 0 of these commands" in text


def test_the_page_is_of_this_form() -> None:
    assert PAGE.read_text(encoding="utf-8").startswith(page([]).split("| --- |")[0])


def test_the_page_is_written_from_the_file_that_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "lines").write_text("\n".join(map(json.dumps, ROWS)))
    monkeypatch.setattr(sys, "argv", ["latency_page", str(tmp_path / "lines"), "--page", str(tmp_path / "page.md")])
    assert main() == 0
    assert (tmp_path / "page.md").read_text() == page(ROWS)


@pytest.mark.parametrize("content", [None, "robot,way\n"])
def test_without_such_a_file_there_is_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], content: str | None
) -> None:
    if content is not None:
        (tmp_path / "lines").write_text(content)
    monkeypatch.setattr(sys, "argv", ["latency_page", str(tmp_path / "lines"), "--page", str(tmp_path / "page.md")])
    assert main() == 2
    said = capsys.readouterr().err
    assert said.startswith(f"{tmp_path / 'lines'}: cannot be read: ")
    assert "fix: measure anew: make latency-page" in said
    assert not (tmp_path / "page.md").exists()


def test_without_an_argument_it_says_which_one_it_takes(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["latency_page"])
    with pytest.raises(SystemExit, match="2"):
        main()
    assert "the following arguments are required: LINES" in capsys.readouterr().err
