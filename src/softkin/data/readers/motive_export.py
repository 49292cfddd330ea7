"""Tracking exports of OptiTrack Motive: text with rows of types, names and axes above the frames."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError
from softkin.data.readers.delimited_text import DelimitedText
from softkin.data.readers.memory_table import Table
from softkin.data.readers.text_encoding import decoded
from softkin.data.readers.text_layout import SAMPLE_BYTES, TextLayout

#: Excel writes semicolons or tabs in place of commas when it saves an export.
FIRST_WORDS = tuple(mark + b"Format Version" + by for mark in (b"", b"\xef\xbb\xbf") for by in (b",", b";", b"\t"))
_UNITS = {"Millimeters": "mm", "Centimeters": "cm", "Meters": "m", "Inches": "in"}
_LINES = 20


def open_table(path: Path, source: Mapping[str, Any]) -> Table:
    """The frames; columns are `Frame`, `Time (Seconds)`, and `<marker>_x`, ..., `<body>_rotation_x`, ... and such as
    `<body>_Mean Marker Error`.

    Raises:
        DataError: its rows of names and axes are not where Motive writes them.
    """
    with open(path, "rb") as file:
        text, encoding = decoded(file.read(SAMPLE_BYTES), is_whole=not file.read(1))
    lines = text.splitlines()[:_LINES]
    delimiter = lines[0][lines[0].index("Format Version") + len("Format Version")]
    rows = [next(csv.reader([line], delimiter=delimiter), []) for line in lines]
    by_label = {row[1]: row for row in rows if len(row) > 1 and row[1] in ("Type", "Name")}
    frame = next((place for place, row in enumerate(rows) if row[:1] == ["Frame"]), None)
    if frame is None or "Name" not in by_label or len(by_label["Name"]) != len(rows[frame]):
        raise DataError("an export of Motive without its rows of names and axes", fix="export it anew with its header")
    axes, kinds, called = rows[frame], rows[frame - 1], by_label["Name"]
    middle = {"Rotation": "_rotation", "Position": ""}
    names = axes[:2] + [
        f"{name}{middle.get(kind, '_' + kind)}{'_' * bool(axis)}{axis.lower()}"
        for name, kind, axis in zip(called[2:], kinds[2:], axes[2:], strict=True)
    ]
    header = dict(zip(rows[0][::2], rows[0][1::2], strict=False))
    unit = _UNITS.get(header.get("Length Units", ""), "")
    units = tuple(unit if kind == "Position" else "" for kind in kinds)
    layout = TextLayout(encoding, delimiter, frame, tuple(names), 1, units)
    return DelimitedText(path, layout, called=source.get("file", ""))
