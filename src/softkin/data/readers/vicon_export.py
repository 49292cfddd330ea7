"""Text exports of Vicon Nexus and Tracker: sections, each with its name, rate, and rows of names, axes and units."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import Table
from softkin.data.readers.tracker_text import frames_table, rows_of_export

#: Sections that hold positions, the first that a file has counts.
SECTIONS = ("Trajectories", "Objects", "Segments", "Joints")
_FIRST = re.compile(
    rb"(\xef\xbb\xbf)?[\s,;]*(Trajectories|Objects|Segments|Joints|Devices|Model Outputs|Events)[,;\t ]*\r?\n"
    rb"[ ]*\d+(\.\d+)?[,;\t ]*\r?\n"
)
#: What a column of axes is in the name of a column: TX is a position of a body, RX its orientation.
_AXES = {f"T{axis}": f"_{axis.lower()}" for axis in "XYZ"} | {
    f"R{axis}": f"_rotation_{axis.lower()}" for axis in "XYZW"
}


def is_export(start: bytes) -> bool:
    """Whether a file begins as an export of Vicon does."""
    return bool(_FIRST.match(start))


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
    """The frames of the first section of `SECTIONS`; columns are `Frame`, `time` (s, by the rate), `Sub Frame` and
    `<subject>:<marker>_x`, ...

    Raises:
        DataError: no such section, or its rows of names and axes are not where Vicon writes them.
    """
    rows = rows_of_export(path)
    starts = {row[0]: line for line, row in reversed(list(enumerate(rows))) if row and not any(row[1:])}
    section = next((name for name in SECTIONS if name in starts), None)
    if section is None:
        raise DataError("an export of Vicon without trajectories", fix="export it anew with its trajectories")
    first = starts[section]
    head = rows[first + 1 : first + 5]
    if len(head) < 4 or head[2][:1] != ["Frame"] or not head[0] or not re.fullmatch(r"\d+([.,]\d+)?", head[0][0]):
        raise DataError(
            f"an export of Vicon whose section {section} has no rows of rate, names, axes and units",
            where=f"line {first + 1}",
            fix="export it anew with its header",
        )
    rate, called, axes, units = head
    names, name = [], ""
    for place, axis in enumerate(axes):
        name = called[place] if place < len(called) and called[place] else name
        ending = _AXES.get(axis.upper(), f"_{axis.lower()}")
        names.append(axis if place < 2 else f"{name}{ending}" if axis else "")
    frames = rows[first + 5 :]
    end = next((place for place, row in enumerate(frames) if not row), len(frames))
    return frames_table(names, units, frames[:end], first + 6, float(rate[0].replace(",", ".")))
