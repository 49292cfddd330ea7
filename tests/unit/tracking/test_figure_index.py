from __future__ import annotations

from pathlib import Path

import pytest

from softkin.tracking.figure_index import content_of, shown_in

INDEX = """figure,title,model,preset,interval_method
ranking,Ranking,lr,paper,
ranking,Ranking,gp,tuned,
robot,Robot,,,
intervals,Intervals,gp,tuned,cps
residuals,Residuals,gp,tuned,
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "index.csv").write_text(INDEX)
    for name in ("ranking", "robot", "intervals", "residuals"):
        (tmp_path / f"{name}.png").write_text(name)
    return tmp_path


def test_a_run_has_the_pictures_that_show_it_in_the_order_of_the_index(folder: Path) -> None:
    shown = {run: [path.name for path in pictures] for run, pictures in shown_in(folder).items()}
    assert shown == {
        ("lr", "paper", ""): ["ranking.png"],
        ("gp", "tuned", ""): ["ranking.png", "residuals.png"],
        ("", "", ""): ["robot.png"],
        ("gp", "tuned", "cps"): ["intervals.png"],
    }


def test_a_model_of_the_name_of_a_missing_value_is_a_model(tmp_path: Path) -> None:
    (tmp_path / "index.csv").write_text("figure,model,preset,interval_method\nranking,nan,None,\n")
    assert list(shown_in(tmp_path)) == [("nan", "None", "")]


def test_a_picture_drawn_anew_is_another_content(folder: Path) -> None:
    pictures = [folder / "ranking.png", folder / "robot.png"]
    before = content_of(pictures)
    assert content_of(pictures) == before
    (folder / "robot.png").write_text("in another style")
    after = content_of(pictures)
    assert after[0] == before[0]
    assert after[1] != before[1]
