"""Encode figures as parts of the page: every picture of a dataset's folder as a data URI.

A picture that is small enough is taken as it is; of a larger one a WebP is made, which takes a tenth of a second.
"""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from PIL import Image

from softkin.reporting.page.marks import Mark

#: All pictures together may take this many bytes, as base64; the page must stay under 10 MB.
BUDGET = 7_000_000
#: The caption of a picture that no index names.
UNNAMED = "A picture that the index of the figures does not name."
#: WebP qualities that are tried, after a lossless one, on a picture that is larger than its part of the budget.
QUALITIES = (90, 75, 60, 40)


@dataclass(frozen=True, slots=True)
class Picture:
    """`uri` is the picture itself; `file` where its full-size original lies, beside the report."""

    title: str
    caption: str
    alternative: str
    uri: str
    width: int
    height: int
    file: str
    is_reduced: bool


@dataclass(frozen=True, slots=True)
class Folder:
    """A folder of figures: `title` names the robot, `marks` are its own."""

    title: str
    path: str | Path
    marks: tuple[Mark, ...] = ()


@dataclass(frozen=True, slots=True)
class Album:
    """The pictures of a folder, under its title."""

    title: str
    marks: tuple[Mark, ...]
    pictures: Sequence[Picture]


def albums(folders: Sequence[Folder], beside: Path) -> list[Album]:
    """The pictures of each folder: those of index.csv in its order, then any other PNG of the folder by name.

    `beside` is the folder of the report. A picture that no index names is titled after its file, and its caption says
    so.
    """
    named = [_named(Path(folder.path)) for folder in folders]
    budget = BUDGET // max(1, sum(map(len, named)))
    return [
        Album(
            folder.title,
            folder.marks,
            [_picture(path, *words, folder.title, budget, beside) for path, words in files.items()],
        )
        for folder, files in zip(folders, named, strict=True)
    ]


def _named(folder: Path) -> dict[Path, tuple[str, str]]:
    """PNG -> title and caption."""
    index = pd.read_csv(folder / "index.csv", dtype=str).fillna("").drop_duplicates("figure")
    known = {folder / f"{row.figure}.png": (str(row.title), str(row.caption)) for row in index.itertuples()}
    others = {path: (path.stem.replace("_", " ").capitalize(), UNNAMED) for path in sorted(folder.glob("*.png"))}
    return known | {path: words for path, words in others.items() if path not in known}


def _picture(path: Path, title: str, caption: str, robot: str, budget: int, beside: Path) -> Picture:
    with Image.open(path) as image:
        kind, content, is_reduced = "png", path.read_bytes(), False
        if len(content) > budget * 3 // 4:
            kind, (content, is_reduced) = "webp", _encoded(image, budget * 3 // 4)
        uri = f"data:image/{kind};base64," + base64.b64encode(content).decode("ascii")
        file = path.relative_to(beside).as_posix()
        return Picture(title, caption, f"{title}: {robot}", uri, image.width, image.height, file, is_reduced)


def _encoded(image: Image.Image, budget: int) -> tuple[bytes, bool]:
    """WebP of at most `budget` bytes, lossless where that suffices: the content, and whether anything was lost."""
    content = _webp(image, lossless=True)
    if len(content) <= budget:
        return content, False
    for quality in QUALITIES:
        content = _webp(image, quality=quality)
        if len(content) <= budget:
            return content, True
    smaller = image.resize((image.width * 3 // 4, image.height * 3 // 4), Image.Resampling.LANCZOS)
    return _encoded(smaller, budget)[0], True


def _webp(image: Image.Image, **options: int) -> bytes:
    stream = io.BytesIO()
    image.convert("RGB").save(stream, format="WEBP", method=4, **options)
    return stream.getvalue()
