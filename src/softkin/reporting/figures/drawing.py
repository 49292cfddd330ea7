"""Draw every figure of a registry as PNG and SVG, with the numbers behind it as CSV."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from softkin.core.csv_tables import write_csv
from softkin.reporting.figures.spec import FigureSpec, Results
from softkin.reporting.figures.style import SETTINGS

logger = logging.getLogger("softkin")

RUN_COLUMNS = ["model", "preset", "interval_method"]


def draw(figures: Mapping[str, FigureSpec[Results]], results: Results, folder: Path) -> None:
    """Write {name}.png, .svg and .csv of each figure into `folder`, and index.csv: which run each of them shows.

    A figure whose frame is empty (its methods or models were not run, or too few trials) is left out, and logged.
    """
    import matplotlib as mpl

    from softkin.reporting.figures.rendering import render

    folder.mkdir(parents=True, exist_ok=True)
    index: list[dict[str, Any]] = []
    for name, spec in figures.items():
        frame = spec.frame(results)
        if frame.empty:
            logger.info("no figure %s: what it shows was not run, or too little of it", name)
            continue
        write_csv(folder / f"{name}.csv", frame)
        with mpl.rc_context(SETTINGS):
            render(spec.plot(frame, results), folder / name)
        runs = frame[RUN_COLUMNS].drop_duplicates().to_dict("records")
        index += [{"figure": name, "title": spec.title, "caption": spec.caption, **run} for run in runs]
        logger.info("figure %s drawn", name)
    columns = ["figure", "title", "caption", *RUN_COLUMNS]
    write_csv(folder / "index.csv", pd.DataFrame(index, columns=columns))
