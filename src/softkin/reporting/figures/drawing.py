"""Draw every figure of a registry: PNG for people, SVG for papers, the frame behind it as CSV."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from softkin.core.files import replacing
from softkin.reporting.figures.spec import FigureSpec, Results
from softkin.reporting.figures.style import SETTINGS

logger = logging.getLogger("softkin")

DPI = 150
RUN_COLUMNS = ["model", "preset", "interval_method"]


def shrink(picture: Path) -> None:
    """A third of the size, to the eye the same: 256 colours, chosen for the picture."""
    from PIL import Image

    with Image.open(picture) as image:
        small = image.convert("RGB").quantize(256, dither=Image.Dither.NONE)
    small.save(picture, format="png")


def draw(figures: Mapping[str, FigureSpec[Results]], results: Results, folder: Path) -> None:
    """Write {name}.png, .svg and .csv of each figure into `folder`, and index.csv: which run each of them shows.

    A figure whose methods or models were not run, or with too few trials, has no rows, and is left out with a line in
    the log.
    """
    import matplotlib as mpl

    folder.mkdir(parents=True, exist_ok=True)
    index: list[dict[str, Any]] = []
    for name, spec in figures.items():
        frame = spec.frame(results)
        if frame.empty:
            logger.info("no %s: nothing of it was run, or too little", name)
            continue
        frame.to_csv(folder / f"{name}.csv", index=False)
        with mpl.rc_context(SETTINGS):
            figure = spec.plot(frame, results)
            for ending, metadata in (("png", {"Software": None}), ("svg", {"Date": None})):
                with replacing(folder / f"{name}.{ending}") as temporary:
                    figure.savefig(temporary, format=ending, dpi=DPI, metadata=metadata)
                    if ending == "png":
                        shrink(temporary)
                figure.set_layout_engine("none")  # it has found the places; finding them again takes as long
        runs = frame[RUN_COLUMNS].drop_duplicates().to_dict("records")
        index += [{"figure": name, "title": spec.title, "caption": spec.caption, **run} for run in runs]
        logger.info("drawn: %s", name)
    columns = ["figure", "title", "caption", *RUN_COLUMNS]
    with replacing(folder / "index.csv") as temporary:
        pd.DataFrame(index, columns=columns).to_csv(temporary, index=False)
