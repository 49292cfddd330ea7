from __future__ import annotations

import base64
import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from softkin.reporting.page import images
from softkin.reporting.page.marks import Mark
from tests.unit.reporting.page.conftest import draw

LEAK = Mark("leak", "It leaks.")


def decoded(uri: str) -> Image.Image:
    return Image.open(io.BytesIO(base64.b64decode(uri.partition(";base64,")[2])))


def test_pictures_are_those_of_the_index_then_the_others_and_nothing_is_lost(tmp_path: Path) -> None:
    draw(tmp_path / "arm" / "figures")
    (album,) = images.albums([images.Folder("ARM", tmp_path / "arm" / "figures", (LEAK,))], tmp_path)
    assert (album.title, album.marks) == ("ARM", (LEAK,))
    first, second = album.pictures
    assert (first.title, second.title) == ("Intervals around the paper's model", "An extra one")
    assert (first.caption, second.caption) == ("How to read it.", images.UNNAMED)
    assert first.alternative == "Intervals around the paper's model: ARM"
    assert first.file == "arm/figures/intervals_paper.png"
    assert (first.width, first.height, first.is_reduced) == (90, 60, False)
    with Image.open(tmp_path / first.file) as original:
        np.testing.assert_array_equal(np.asarray(decoded(first.uri)), np.asarray(original.convert("RGB")))


def test_pictures_keep_to_the_budget_and_say_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    draw(tmp_path / "arm" / "figures")
    monkeypatch.setattr(images, "BUDGET", 2400)
    (album,) = images.albums([images.Folder("ARM", tmp_path / "arm" / "figures")], tmp_path)
    shown = album.pictures
    assert sum(len(picture.uri) for picture in shown) <= 2400 + 2 * len("data:image/webp;base64,")
    assert all(picture.is_reduced for picture in shown)
    assert (shown[0].width, shown[0].height) == (90, 60)  # the page keeps its layout


def test_a_robot_without_figures_has_none(tmp_path: Path) -> None:
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures" / "index.csv").write_text("figure,title,caption,model,preset,interval_method\n")
    (album,) = images.albums([images.Folder("ARM", tmp_path / "figures")], tmp_path)
    assert album.pictures == []


def test_two_robots_of_one_title_keep_their_own_pictures(tmp_path: Path) -> None:
    for name in ("left", "right"):
        draw(tmp_path / name)
    albums = images.albums([images.Folder("ARM", tmp_path / name) for name in ("left", "right")], tmp_path)
    assert [album.pictures[0].file for album in albums] == ["left/intervals_paper.png", "right/intervals_paper.png"]
