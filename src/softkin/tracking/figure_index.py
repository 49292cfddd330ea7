"""Read which run each figure of a dataset shows."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from softkin.core.files import sha256_of

#: (model, preset, interval_method) -> the pictures it is shown in; '' where a figure shows no single one.
Shown = dict[tuple[str, str, str], list[Path]]


def shown_in(folder: str | Path) -> Shown:
    """The pictures by run, from the index.csv in the `folder` of a dataset's figures."""
    pictures: Shown = {}
    index = pd.read_csv(Path(folder) / "index.csv", dtype=str, keep_default_na=False)
    for row in index.to_dict("records"):
        run = (row["model"], row["preset"], row["interval_method"])
        pictures.setdefault(run, []).append(Path(folder) / f"{row['figure']}.png")
    return pictures


def content_of(pictures: Sequence[Path]) -> list[str]:
    """SHA-256 of each picture: a figure that is drawn in another style is another content."""
    return [sha256_of([picture]) for picture in pictures]
