"""Points of a C3D file, the format that trackers of all makers write. It needs ezc3d."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import MemoryTable, Table
from softkin.data.readers.optional_library import library


def is_c3d(start: bytes) -> bool:
    """Whether a file begins as C3D does: the number of its first block of parameters, then 0x50."""
    return len(start) > 1 and 2 <= start[0] <= 8 and start[1] == 0x50


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
    """The points of all frames; columns are `Frame`, `time` (s), `<label>_x`, ... A point that was not seen is a gap.

    Raises:
        DataError: ezc3d is not installed, or the file is damaged or has no points.
    """
    ezc3d = library("ezc3d", "a C3D file", "export the points as CSV")
    try:
        content = ezc3d.c3d(str(path))
        points = np.asarray(content["data"]["points"], dtype=np.float64)[:3]
        about = content["parameters"]["POINT"]
        labels = [str(label).strip() for label in about["LABELS"]["value"]]
        rate, first = float(about["RATE"]["value"][0]), int(content["header"]["points"]["first_frame"])
        unit = str(next(iter(about.get("UNITS", {}).get("value", [])), ""))
        seen = np.asarray(content["data"]["meta_points"]["residuals"])[0] >= 0
    except (OSError, RuntimeError, ValueError, KeyError, IndexError, TypeError) as error:
        raise DataError(f"not readable as C3D: {error}", fix="export the points as CSV") from error
    if not points.size:
        raise DataError("a C3D file without points", fix="export the trajectories of the markers, too")
    points[:, ~seen] = np.nan
    frame = np.arange(points.shape[2], dtype=np.float64) + first + 1
    names = ["Frame", "time", *(f"{label}_{axis}" for label in labels for axis in "xyz")]
    columns = [frame, (frame - 1) / rate, *points[:, : len(labels)].transpose(1, 0, 2).reshape(-1, len(frame))]
    units = ("", "s", *[unit] * (len(names) - 2))
    return MemoryTable(tuple(names), tuple(columns), lambda row: f"frame {int(frame[row])}", units)
