from __future__ import annotations

import base64
import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from softkin.reporting.page import images
from tests.unit.reporting.page.conftest import draw


def decoded(uri: str) -> Image.Image:
    return Image.open(io.BytesIO(base64.b64decode(uri.removeprefix("data:image/webp;base64,"))))


def test_pictures_are_those_of_the_index_then_the_others_and_nothing_is_lost(tmp_path: Path) -> None:
    draw(tmp_path / "arm" / "figures")
    first, second = images.pictures({"arm": tmp_path / "arm" / "figures"}, {"arm": "ARM"}, tmp_path)["arm"]
    assert (first.title, second.title) == ("Intervals around the paper's model", "An extra one")
    assert (first.caption, second.caption) == ("How to read it.", "")
    assert first.alternative == "Intervals around the paper's model: ARM"
    assert first.file == "arm/figures/intervals_paper.png"
    assert (first.width, first.height, first.is_reduced) == (90, 60, False)
    with Image.open(tmp_path / first.file) as original:
        np.testing.assert_array_equal(np.asarray(decoded(first.uri)), np.asarray(original.convert("RGB")))


def test_pictures_keep_to_the_budget_and_say_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    draw(tmp_path / "arm" / "figures")
    monkeypatch.setattr(images, "BUDGET", 2400)
    shown = images.pictures({"arm": tmp_path / "arm" / "figures"}, {"arm": "ARM"}, tmp_path)["arm"]
    assert sum(len(picture.uri) for picture in shown) <= 2400 + 2 * len("data:image/webp;base64,")
    assert all(picture.is_reduced for picture in shown)
    assert (shown[0].width, shown[0].height) == (90, 60)  # the page keeps its layout


def test_a_robot_without_figures_has_none(tmp_path: Path) -> None:
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures" / "index.csv").write_text("figure,title,caption,model,preset,interval_method\n")
    assert images.pictures({"arm": tmp_path / "figures"}, {"arm": "ARM"}, tmp_path) == {"arm": []}
