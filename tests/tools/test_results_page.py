from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from tests.conftest import HOUSE
from tests.tools.small_run import write_small_run
from tools.finished_run import TITLES
from tools.gallery import BEGIN, END
from tools.results_page import MAX_WIDTH, TEMPLATE, main, make_results_page, wrapped


@pytest.fixture
def results(tmp_path: Path) -> Path:
    write_small_run(tmp_path / "results")
    return tmp_path / "results"


@pytest.fixture
def page(results: Path) -> str:
    path = results.parent / "results.md"
    make_results_page(results, path)
    return path.read_text()


def test_numbers_of_the_page_are_those_of_the_tables(page: str) -> None:
    sentences = " ".join(page.split())
    assert "reproduces **2 of 3** printed cells" in sentences
    assert (
        "in **1 of 3** and ties in 1; our best model is at least as good as the paper's best in **1 of 2** columns"
        in sentences
    )
    assert "and FINGER has some" in sentences
    assert "On 1 of 2 robots" in sentences
    assert "4 of 4 studies chose" in sentences
    assert "in **4 of 4** cases" in sentences
    # m1_y lies outside its band on both robots; m1_z of FINGER never moves.
    assert "Of the 5 moving coordinates of all robots, the coverage of 3 lies in its exact band" in sentences
    assert "At a nominal 90 %" in sentences
    for row in (
        "| FINGER (real tendon finger) | 2 | 1 | 70 | 9 | 8 | 31 | `fingerfinger` |",
        f"| FINGER | extrapolation | {TITLES.models['gb']} | MAE (mm) | 4.28 | 4.56 |",
        f"| FINGER | extrapolation | {TITLES.models['gb']} | R2 | 0.97 | 0.971 | 0.910 | 3.00 |",
        f"| RMSE (mm) | 5.40 ({TITLES.models['gb']}) | 2.08 ({TITLES.models['gp']}) | better |",
        f"| FINGER | {TITLES.run('gp', 'tuned')} | curvature | 2.00\\* / 1.00 | 5.40 / 4.28 | 0.100 | 0.500 |",
        f"| My arm | {TITLES.run('lr', 'outer')} | curvature | 2.00 / 1.00 | – / – | 0.900 | 0.500 |",
        f"| {TITLES.models['lr']} | 0.500 | 0.500 |",
    ):
        assert row in page, row


def test_robots_in_time_have_a_section_of_their_own(results: Path, page: str) -> None:
    assert "## In time" not in page
    recorded: dict[str, Any] = {"dataset": "finger", "split": "next_session", "model": "gp", "preset": "tuned"}
    recorded |= {
        "memory": "play",
        "subset": "2 after 1",
        "method": "recalibrated",
        "rmse_mm": 0.5,
        "mae_mm": 0.25,
        "coverage": 0.9,
    }
    recorded |= {"mean_width_mm": 2.0, "winkler_mm": 3.0, "n_recalibration_poses": 5, "leak": False}
    parts = [
        recorded
        | {"split": "next_session_in_parts", "subset": f"2 after 1, block {block} of 4"}
        | {"method": method, "coverage": 0.7 + block / 10, "memory": memory}
        for block in (1, 2)
        for method in ("split conformal", "adaptive")
        for memory in ("none", "play")
    ]
    pd.DataFrame([recorded, *parts]).to_csv(results / "tables" / "recorded.csv", index=False)
    make_results_page(results, results.parent / "results.md")
    page = (results.parent / "results.md").read_text()
    of_block = (
        "| FINGER | next session, part by part | 2 after 1, block 1 of 4 | play | 80.0 % at 2.00 | 80.0 % at 2.00 |"
    )
    assert of_block in page
    assert "part by part | 2 after 1, block 1 of 4 | none" not in page
    assert "| FINGER | next session | 2 after 1 | play | recalibrated | 5 | 0.500 / 0.250 | 90.0 % | 2.00 |" in page


def test_intervals_stand_beside_the_papers_recipe_and_say_their_role(page: str) -> None:
    rows = [line.split(" | ") for line in page.splitlines() if " | 5.13" in line]
    assert [row[:2] for row in rows] == [
        ["| FINGER (leak)", "deployed"],
        ["| FINGER (leak)", "chosen"],
        ["| My arm", "chosen and deployed"],
    ]
    assert [row[5] for row in rows] == ["5.13", "5.13\\*", "5.13"]  # one of them hangs on a single row
    assert "| FINGER (leak) | the paper's recipe | " in page
    around = TITLES.run("gp", "tuned")
    ratio = "1.28 (1.20 to 1.40)"
    assert f"| FINGER | {around}, deployed | 97.4 % | 96.0 % | 93.0 % | {ratio} | 1.25 | 85.0 % | {ratio} |" in page
    assert f"| My arm | {around} | – | – | – | – | – | 85.0 % | – |" in page  # listed for one, listed for all
    few = "not assessable: 12 commands"
    around = TITLES.run("lr", "outer")
    assert f"| My arm | {around}, deployed | 97.4 % | 96.0 % | 93.0 % | {few} | 1.25 | 85.0 % | {few} |" in page
    weighted = TITLES.methods["weighted"]
    assert f"| FINGER | {weighted} | none | refuses | 0.0 % | 1.28 | 0.999 | 7.50 |" in page
    assert "| FINGER (leak) | 8 | 5.00 | 100.0 % | 2.0 % to 40.0 % |" in page


def test_leaks_are_named(page: str) -> None:
    assert "- FINGER: 8 of 8 rows leak. Bad." in page
    assert "My arm:" not in page


def test_without_a_published_robot_nothing_is_compared(results: Path) -> None:
    for name in ("published_comparison", "published_columns"):
        frame = pd.read_csv(results / "tables" / f"{name}.csv")
        frame.iloc[:0].to_csv(results / "tables" / f"{name}.csv", index=False)
    page = results.parent / "results.md"
    make_results_page(results, page)
    assert "paper's numbers" not in page.read_text()
    assert f"| FINGER | {TITLES.run('gp', 'tuned')} | curvature | 2.00\\* / 1.00 | – / – |" in page.read_text()


def test_a_second_time_changes_nothing_and_the_gallery_is_kept(results: Path, page: str) -> None:
    path = results.parent / "results.md"
    make_results_page(results, path)
    assert path.read_text() == page
    gallery = f"{BEGIN}\n| a picture |\n{END}"
    path.write_text(page.replace(f"{BEGIN}\n{END}", gallery))
    make_results_page(results, path)
    assert gallery in path.read_text()


def test_a_missing_table_is_named(
    results: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    missing = results / "tables" / "searched_runs.csv"
    missing.unlink()
    page = results.parent / "results.md"
    monkeypatch.setattr(sys, "argv", ["results_page", "--results", str(results), "--page", str(page)])
    assert main() == 1
    assert capsys.readouterr().err == (
        f"{missing}: no such table\n  fix: run the default configuration first: make run\n"
    )
    assert not page.exists()


def test_lines_are_filled_and_tables_left_alone() -> None:
    long = "word " * 60
    table = "| " + "cell " * 60 + "|\n| --- |"
    text = wrapped(f"# Title\n\n{long}\n\n- {long}\n- short\n\n{table}\n")
    assert table in text
    assert all(len(line) <= MAX_WIDTH for line in text.splitlines() if not line.startswith("|"))
    assert "\n  word" in text


def test_the_template_holds_no_number() -> None:
    written = r"\{\{.*?\}\}|\{%.*?%\}|`[^`]*`|\bR2\b"
    words = re.sub(written, "", TEMPLATE.read_text(), flags=re.DOTALL)
    assert not re.findall(r"\d+", words)


def test_our_own_page_is_what_the_template_makes() -> None:
    """Every text of the template stands in docs/results.md: after an edit of the template, `make results-page`."""
    page = " ".join((HOUSE / "docs" / "results.md").read_text().split())
    texts = re.split(r"\{\{.*?\}\}|\{%.*?%\}", TEMPLATE.read_text(), flags=re.DOTALL)
    missing = [" ".join(text.split()) for text in texts if " ".join(text.split()) not in page]
    assert missing == ["The audit found no leak."]
