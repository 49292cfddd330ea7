"""Text exports of NDI First Principles (Optotrak): number of frames, rate and unit above the frames."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import Table
from softkin.data.readers.tracker_text import frames_table, rows_of_export

FIRST_WORDS = (b"Number of frames:", b"\xef\xbb\xbfNumber of frames:")


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
    """The frames; columns are `Frame`, `time` (s, by the rate) and `<marker> x`, ..., as NDI names them.

    Raises:
        DataError: its row of names is not where NDI writes it, or it holds fewer frames than it says.
    """
    rows = rows_of_export(path)
    top = next((line for line, row in enumerate(rows) if row[:1] == ["Frame"]), None)
    if top is None:
        raise DataError("an export of NDI without its row of names", fix="export again with the header")
    lines = [row[0].partition(":") for row in rows[:top] if row]
    told = {key.strip(): value.strip() for key, _, value in lines}
    frames = rows[top + 1 :]
    while frames and not frames[-1]:
        frames.pop()
    wanted = told.get("Number of frames", "")
    if wanted.isdecimal() and int(wanted) != len(frames):
        raise DataError(
            f"{len(frames)} frames, but its first line says {wanted}",
            where="the whole file",
            fix="export again; this file was cut off, or frames were deleted by hand",
        )
    rate, unit, names = told.get("Frequency", ""), told.get("Units", ""), rows[top]
    units = ["" if place == 0 else unit for place in range(len(names))]
    return frames_table(names, units, frames, top + 2, float(rate) if re.fullmatch(r"\d+(\.\d+)?", rate) else None)
