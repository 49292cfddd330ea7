from __future__ import annotations

from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from softkin.reporting.figures.rendering import DPI, SCALE, render


def plotted(*, rasterized: bool = False) -> Figure:
    """Lines, marks, text, a grid of cells and a picture."""
    figure = Figure(figsize=(4, 3), layout="constrained")
    left, right = figure.subplots(1, 2)
    x = np.linspace(0, 1, 50)
    left.plot(x, x**2, linewidth=2, linestyle="--", label="a curve")
    left.scatter(x, 1 - x, s=9, rasterized=rasterized)
    left.set_xlabel("command")
    left.legend()
    figure.colorbar(right.pcolormesh(np.outer(x, x)), ax=right)
    return figure


def test_the_picture_is_the_one_that_matplotlib_draws(tmp_path: Path) -> None:
    render(plotted(), tmp_path / "figure")
    expected = BytesIO()
    plotted().savefig(expected, format="png", dpi=DPI)
    ours = np.asarray(Image.open(tmp_path / "figure.png").convert("RGB"), dtype=float)
    theirs = np.asarray(Image.open(expected).convert("RGB"), dtype=float)
    assert ours.shape == theirs.shape == (3 * DPI, 4 * DPI, 3)
    assert np.abs(ours - theirs).mean() < 2  # of 255: the picture has 256 colours


def test_the_drawing_has_the_size_of_the_figure_and_lines_as_wide_as_asked_for(tmp_path: Path) -> None:
    render(plotted(), tmp_path / "figure")
    root = ElementTree.parse(tmp_path / "figure.svg").getroot()
    assert (root.get("width"), root.get("height")) == ("288pt", "216pt")
    assert root.get("viewBox") == f"0 0 {4 * DPI} {3 * DPI}"
    styles = [element.get("style") or "" for element in root.iter()]
    widths = {float(style.split("stroke-width: ")[1].split(";")[0]) for style in styles if "stroke-width: " in style}
    assert any(width == pytest.approx(2 * SCALE, rel=1e-4) for width in widths)


def test_what_is_rasterized_is_a_picture_in_the_drawing(tmp_path: Path) -> None:
    for name, rasterized in (("paths", False), ("pixels", True)):
        render(plotted(rasterized=rasterized), tmp_path / name)
    images = {name: (tmp_path / f"{name}.svg").read_text().count("<image") for name in ("paths", "pixels")}
    assert images["pixels"] == images["paths"] + 1
    assert (tmp_path / "pixels.svg").stat().st_size < (tmp_path / "paths.svg").stat().st_size + 20_000


def test_the_same_figure_gives_the_same_files(tmp_path: Path) -> None:
    for name in ("one", "two"):
        render(plotted(), tmp_path / name)
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "two.png").read_bytes()
