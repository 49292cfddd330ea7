from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from softkin.core.errors import SoftkinError
from softkin.core.files import write_json
from softkin.reporting.figures import FIGURES
from tests.conftest import HOUSE
from tools.gallery import BEGIN, END, FOLDER, MAX_BYTES, PICTURES, main, make_gallery


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """A run of two robots, one of them leaking; the first picture is noise, which no compression makes small."""
    folder = tmp_path / "results"
    rng = np.random.default_rng(0)
    for place, (where, figure) in enumerate(PICTURES):
        figures = folder / where / "figures"
        figures.mkdir(parents=True, exist_ok=True)
        pixels = rng.integers(0, 256, (600, 900, 3)) if place == 0 else np.full((600, 900, 3), 200)
        Image.fromarray(pixels.astype(np.uint8)).save(figures / f"{figure}.png")
        index = pd.DataFrame([{"figure": name, "title": FIGURES[name].title} for _, name in PICTURES] * 2)
        index.to_csv(figures / "index.csv", index=False)
    (folder / "tables").mkdir()
    robots, scores, choices = ("arm", "finger"), [], []
    for robot in robots:
        leak = {"severity": "leak", "subsets": ["test"]}
        write_json(folder / robot / "dataset.json", {"title": robot.upper()})
        write_json(folder / robot / "data_card.json", {"findings": [leak] if robot == "arm" else []})
        for subset, error in (("test", 0.5), ("extrapolation", 2.0)):
            for preset, factor in (("paper", 9.0), ("tuned", 1.0)):
                errors = {"euclidean_mean_mm": factor * error, "euclidean_p95_mm": 2 * factor * error}
                scores.append({"dataset": robot, "model": "gp", "preset": preset, "subset": subset} | errors)
        for given, covers in ((True, 0.912), (False, 0.7)):
            values = {
                "confidence_level": 0.9,
                "test_mean_width_mm": 1.5,
                "test_coverage": covers,
                "extrapolation_coverage": 0.88,
            }
            choices.append({"dataset": robot, "chosen": not given, "deployed": given} | values)
    selection = [{"dataset": robot, "model": "gp", "preset": "tuned", "deployed": True} for robot in robots]
    for name, rows in (("selection", selection), ("point_metrics", scores), ("interval_choice", choices)):
        pd.DataFrame(rows).to_csv(folder / "tables" / f"{name}.csv", index=False)
    return folder


def test_the_readme_gets_four_pictures_and_a_table(results: Path, tmp_path: Path) -> None:
    readme = tmp_path / "README.md"
    readme.write_text(f"# softkin\n\n{BEGIN}\nold\n{END}\n\nThe rest.\n")
    make_gallery(results, readme)
    text = readme.read_text()
    assert text.startswith(f"# softkin\n\n{BEGIN}\n")
    assert text.endswith(f"{END}\n\nThe rest.\n")
    assert "old" not in text
    assert "| FINGER | Gaussian process | 0.500 | 1.00 | 2.00 | 1.50 | 91.2% | 88.0% |" in text
    assert "| ARM (LEAK: test rows stand in train) |" in text
    for folder, figure in PICTURES:
        path = FOLDER / f"{folder}_{figure}.png"
        assert f"![{FIGURES[figure].title}, {folder}]({path.as_posix()})" in text
        assert (tmp_path / path).stat().st_size <= MAX_BYTES
        with Image.open(tmp_path / path) as image:
            assert image.width / image.height == pytest.approx(1.5, abs=0.01)
    make_gallery(results, readme)
    assert readme.read_text() == text


def test_what_is_missing_is_named(
    results: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    readme = tmp_path / "README.md"
    readme.write_text("# softkin\n")
    with pytest.raises(SoftkinError, match="no place for the gallery"):
        make_gallery(results, readme)
    readme.write_text(f"{BEGIN}\n{END}\n")
    missing = results / PICTURES[-1][0] / "figures" / f"{PICTURES[-1][1]}.png"
    missing.unlink()
    monkeypatch.setattr(sys, "argv", ["gallery", "--results", str(results), "--readme", str(readme)])
    assert main() == 1
    assert capsys.readouterr().err == f"{missing} is not there\n  mend: run the default configuration first: make run\n"
    assert readme.read_text() == f"{BEGIN}\n{END}\n"


def test_our_own_readme_has_its_place_and_shows_figures_that_exist() -> None:
    text = (HOUSE / "README.md").read_text()
    assert text.index(BEGIN) < text.index(END)
    for _, figure in PICTURES:
        assert figure in FIGURES
    shown = text.split(BEGIN)[1].split(END)[0].split("](")[1:]
    assert all((HOUSE / link.split(")")[0]).is_file() for link in shown)
