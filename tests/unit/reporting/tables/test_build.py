from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from markdown import markdown  # type: ignore[import-untyped]

from softkin.reporting.tables.build import build_tables
from softkin.reporting.tables.frames import Tables
from softkin.reporting.titles import Titles
from tests.nasty import NASTY
from tests.unit.reporting.tables.conftest import Run, write_run

TITLES = Titles({"gb": "Gradient boosting", "lr": "Linear regression"}, {"cqr": "CQR", "scp_mapie": "SCP (MAPIE)"})


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> Tables:
    return write_run(tmp_path_factory.mktemp("run")).tables()


@pytest.fixture(scope="module")
def folder(tables: Tables, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All tables of a run."""
    folder = tmp_path_factory.mktemp("tables")
    build_tables(tables, titles=TITLES, folder=folder)
    return folder


def test_each_frame_is_a_csv_as_it_is(tables: Tables, folder: Path) -> None:
    frames = tables.frames
    assert {path.stem for path in folder.glob("*.csv")} == set(frames)
    for name, frame in frames.items():
        assert (folder / f"{name}.csv").read_text() == frame.to_csv(index=False), name


def test_the_papers_tables_come_in_its_order_with_what_is_not_comparable(folder: Path) -> None:
    text = (folder / "paper_tables.md").read_text()
    headings = [line for line in text.splitlines() if line.startswith("###")]
    assert headings == [
        "### Table 2: data description",
        "### Table 5: comparison on FINGER",
        "### Comparison on ARM (not in the paper)",
        "### Table 6: conformal prediction and quantile regression",
    ]
    assert "Testing: LEAK: All rows stand in train." in text
    assert "Extrapolation: Far out." in text
    latex = (folder / "paper_tables.tex").read_text()
    assert latex.count(r"\begin{table}") == len(headings)


def test_the_preface_names_the_columns_that_there_are(folder: Path) -> None:
    text = (folder / "paper_tables.md").read_text()
    assert "Each metric has three columns: the cell as printed; ours with the paper's settings (paper); ours" in text
    header = next(line for line in text.splitlines() if line.startswith("| Method"))
    assert header.count("RMSE") == 3


def test_with_the_outer_preset_there_are_four(run: Run, tmp_path: Path) -> None:
    for files in run.datasets.values():
        table = pd.read_csv(files.point)
        outer = table[table["preset"] == "tuned"].assign(preset="outer")
        pd.concat([table, outer]).to_csv(files.point, index=False)
    build_tables(run.tables(), titles=TITLES, folder=tmp_path / "tables")
    text = (tmp_path / "tables" / "paper_tables.md").read_text()
    assert "Each metric has four columns" in text
    assert "outer shells of train found (outer)" in text
    assert next(line for line in text.splitlines() if line.startswith("| Method")).count("RMSE") == 4


def test_the_interval_tables_show_what_is_chosen_and_what_is_deployed(folder: Path) -> None:
    text = (folder / "interval_tables.md").read_text()
    assert "| CQR, chosen | Gradient boosting, tuned |" in text
    assert "| SCP (MAPIE), deployed | Gradient boosting, tuned |" in text
    assert "FINGER: Chosen is CQR (Gradient boosting, tuned)" in text
    assert "| *ARM (LEAK)* |" in text
    assert "ARM, test: LEAK: All rows stand in train." in text
    assert "Far out" not in text  # of test rows alone
    assert r"\emph{ARM (LEAK)}" in (folder / "interval_tables.tex").read_text()


def test_the_headline_names_the_deployed_models_and_the_leak(folder: Path) -> None:
    text = (folder / "headline.txt").read_text()
    assert "finger gb tuned 1.00 1.00 1.00" in " ".join(text.split())
    assert "finger gb tuned scp_mapie 2.00 91.0 % 91.0 %" in " ".join(text.split())
    assert "arm: LEAK" in text
    assert "finger: LEAK" not in text
    assert "printed cells" in text


def test_a_caution_stands_in_all_that_is_read_as_text(tables: Tables, folder: Path, tmp_path: Path) -> None:
    build_tables(tables, titles=TITLES, folder=tmp_path, caution="Few trials.")
    for name in ("headline.txt", "paper_tables.md", "interval_tables.md"):
        assert "CAUTION: Few trials." in (tmp_path / name).read_text()
        assert "CAUTION" not in (folder / name).read_text()


def test_where_nothing_was_searched_the_headline_has_intervals_alone(run: Run, tmp_path: Path) -> None:
    build_tables(run.tables(searched=False), titles=TITLES, folder=tmp_path)
    text = (tmp_path / "headline.txt").read_text()
    assert "The model is chosen" not in text
    assert "intervals of the calibrated models" in text


def test_robots_that_the_paper_does_not_have_have_no_table_6(run: Run, tmp_path: Path) -> None:
    own = Run({"arm": run.datasets["arm"]}, {key: path for key, path in run.parameters.items() if key[0] == "arm"})
    build_tables(own.tables(), titles=TITLES, folder=tmp_path)
    text = (tmp_path / "paper_tables.md").read_text()
    assert "Table 6" not in text
    assert "nothing was run that the paper has printed" in text
    assert "printed |" not in text


def test_titles_notes_and_cautions_are_text_in_every_table(run: Run, tmp_path: Path) -> None:
    tables = run.tables()
    sources = {name: {**entry, "title": NASTY} for name, entry in tables.sources.items()}
    descriptions = [{**description, "title": NASTY} for description in tables.descriptions]
    notes = dict.fromkeys([("finger", "test"), ("arm", "extrapolation")], NASTY)
    frames = dict(tables.frames)
    frames["published_comparison"] = frames["published_comparison"].assign(note=NASTY)
    nasty = replace(tables, sources=sources, descriptions=descriptions, notes=notes, frames=frames)
    build_tables(nasty, titles=TITLES, folder=tmp_path / "tables", caution=NASTY)
    for path in (tmp_path / "tables").glob("*.md"):
        html = markdown(path.read_text(), extensions=["tables"])
        assert "calc" in html, path.name
        assert not re.search(r"<(a|img|script)\b", html), path.name
    for path in (tmp_path / "tables").glob("*.tex"):
        commands = set(re.findall(r"\\([a-zA-Z]+)", path.read_text()))
        assert not commands & {"input", "write", "frac"}, path.name
    for path in (tmp_path / "tables").glob("*.csv"):
        assert not re.search(r'(^|,)"?[=@]', path.read_text(), re.MULTILINE), path.name
    assert "\x1b" not in (tmp_path / "tables" / "headline.txt").read_text()
