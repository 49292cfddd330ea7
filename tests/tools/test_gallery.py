"""The gallery of docs/results.md."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from softkin.core.errors import DataError, SoftkinError
from softkin.core.files import write_json
from softkin.reporting.figures import FIGURES
from tests.conftest import HOUSE
from tools.finished_run import FinishedRun
from tools.gallery import BEGIN, END, FOLDER, MAX_BYTES, MAX_WIDTH, PAGE, PICTURES, main, make_gallery, notes
from tools.results_page import wrapped

LEAK = {"code": "copied_commands", "severity": "leak", "subsets": ["test"], "rows": {}}
STUCK = {"code": "stuck_poses", "severity": "warning", "subsets": ["train", "test"], "rows": {"test": [3, 5]}}
#: Mean and 95 % quantile of the errors on test, mm.
ERRORS = {"elastica": (4e-7, 2e-6), "finger": (0.5, 1.0), "abaqus": (0.4, 0.02)}


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """Of three robots: `elastica` leaks, a few rows carry the mean of `abaqus`, and the finger is recorded, too."""
    folder = tmp_path / "results"
    for where, figure in PICTURES:
        figures = folder / where / "figures"
        figures.mkdir(parents=True, exist_ok=True)
        Image.fromarray(np.full((60, 90, 3), 200, dtype=np.uint8)).save(figures / f"{figure}.png")
        words = [{"figure": name, "title": FIGURES[name].title, "caption": FIGURES[name].caption} for name in FIGURES]
        pd.DataFrame(words * 2).to_csv(figures / "index.csv", index=False)
    (folder / "tables").mkdir()
    scores, choices = [], []
    for recorded in {where for where, _ in PICTURES} - set(ERRORS):
        write_json(folder / recorded / "dataset.json", {"title": "FINGER in time (made up)", "rows": {"test": 40}})
        write_json(folder / recorded / "data_card.json", {"findings": []})
    for robot, (mean, p95) in ERRORS.items():
        findings = {
            "elastica": [LEAK | {"sentence": "2 of 40 rows.", "consequence": "Training error."}],
            "abaqus": [STUCK],
        }
        write_json(folder / robot / "dataset.json", {"title": f"{robot.upper()} (made up)", "rows": {"test": 40}})
        write_json(folder / robot / "data_card.json", {"findings": findings.get(robot, [])})
        for subset, factor in (("test", 1.0), ("extrapolation", 4.0)):
            for preset, worse in (("paper", 9.0), ("tuned", 1.0)):
                errors = {"euclidean_mean_mm": worse * factor * mean, "euclidean_p95_mm": worse * factor * p95}
                scores.append({"dataset": robot, "model": "gp", "preset": preset, "subset": subset} | errors)
        for is_deployed, coverage in ((True, 0.912), (False, 0.7)):
            shares = {"test_coverage": coverage, "extrapolation_coverage": 0.88, "extrapolation_assessable": True}
            values = {"confidence_level": 0.9, "test_mean_width_mm": 3 * mean} | shares
            choices.append({"dataset": robot, "chosen": not is_deployed, "deployed": is_deployed} | values)
    selection = [{"dataset": robot, "model": "gp", "preset": "tuned", "deployed": True} for robot in ERRORS]
    for name, rows in (("selection", selection), ("point_metrics", scores), ("interval_choice", choices)):
        pd.DataFrame(rows).to_csv(folder / "tables" / f"{name}.csv", index=False)
    return folder


@pytest.fixture
def page(tmp_path: Path) -> Path:
    """A page with a place for the gallery."""
    path = tmp_path / "docs" / "results.md"
    path.parent.mkdir()
    path.write_text(f"# Results\n\n{BEGIN}\nold\n{END}\n\nThe rest.\n")
    return path


def test_the_page_gets_a_table_and_pictures_with_their_captions(results: Path, page: Path) -> None:
    """The first picture is noise, which no compression makes small."""
    where, figure = PICTURES[0]
    noise = np.random.default_rng(0).integers(0, 256, (600, 900, 3), dtype=np.uint8)
    Image.fromarray(noise).save(results / where / "figures" / f"{figure}.png")
    make_gallery(results, page)
    text = page.read_text()
    assert text.startswith(f"# Results\n\n{BEGIN}\n")
    assert text.endswith(f"{END}\n\nThe rest.\n")
    assert "\nold\n" not in text
    for dataset, figure in PICTURES:
        path = Path(FOLDER) / f"{dataset}_{figure}.png"
        assert f"({path.as_posix()})" in text
        assert FIGURES[figure].caption in text.replace("\n", " ")
        assert (page.parent / path).stat().st_size <= MAX_BYTES
        with Image.open(page.parent / path) as image:
            assert image.width / image.height == pytest.approx(1.5, abs=0.01)
    assert all(len(line) <= MAX_WIDTH for line in text.splitlines() if not line.startswith("|"))


def test_the_table_leads_with_the_largest_error_and_ends_with_what_leaks(results: Path, page: Path) -> None:
    make_gallery(results, page)
    rows = [line for line in page.read_text().splitlines() if line.startswith("|")][2:]
    finger, abaqus, elastica = rows
    assert finger.startswith(
        "| FINGER (made up) | Gaussian process | 1.00 mm | 0.500 mm | 2.00 mm | 1.50 mm | 91.2 % |"
    )
    assert abaqus.startswith("| ABAQUS (made up) | Gaussian process | 0.0200 mm | 0.400 mm |")
    assert elastica.startswith("| ELASTICA (made up) (leak) | Gaussian process | 0.00000200 mm | below a nanometre |")
    assert not any(re.search(r"\de-\d", row) for row in rows)


def test_a_mean_that_few_rows_carry_and_a_leak_have_their_sentence(results: Path) -> None:
    carried, leak = notes(FinishedRun(results))
    assert carried.startswith("*ABAQUS*: a few rows carry the mean on test")
    assert "2 of its 40 rows are gross errors" in carried
    assert leak == "*ELASTICA*: LEAK: 2 of 40 rows. Training error."


def test_writing_gallery_or_page_anew_changes_nothing(results: Path, page: Path) -> None:
    make_gallery(results, page)
    text = page.read_text()
    assert wrapped(text) + "\n" == text
    make_gallery(results, page)
    assert page.read_text() == text


def test_what_is_missing_is_named(
    results: Path, page: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    before = page.read_text()
    missing = results / PICTURES[-1][0] / "figures" / f"{PICTURES[-1][1]}.png"
    missing.unlink()
    with pytest.raises(DataError) as raised:
        make_gallery(results, page)
    assert raised.value.where == str(missing)
    monkeypatch.setattr(sys, "argv", ["gallery", "--results", str(results), "--page", str(page)])
    assert main() == 1
    assert capsys.readouterr().err == f"{missing}: no such file\n  fix: run the default configuration first: make run\n"
    assert page.read_text() == before
    page.write_text("# Results\n")
    with pytest.raises(SoftkinError, match="no place for the gallery\n  fix: write the page first: make results-page"):
        make_gallery(results, page)


def test_pictures_are_figures_that_are_drawn() -> None:
    assert {figure for _, figure in PICTURES} <= set(FIGURES)
    assert PICTURES[0] == ("finger", "robot")


def test_our_own_results_page_has_a_gallery_whose_pictures_exist() -> None:
    text = (HOUSE / PAGE).read_text()
    gallery = text[text.index(BEGIN) : text.index(END)]
    links = re.findall(r"\]\(([^)]*\.png)\)", gallery)
    assert links == [f"{FOLDER}/{dataset}_{figure}.png" for dataset, figure in PICTURES]
    assert all(((HOUSE / PAGE).parent / link).is_file() for link in links)
