"""Text exports of trackers whose rows of names, axes and units stand above the frames, each tracker in its own way."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from softkin.data.readers.memory_table import MemoryTable
from softkin.data.readers.text_encoding import decoded

#: A coordinate below this is none: NDI writes -3.697e28 of a marker that it does not see.
NOT_SEEN = -1e25
#: Called by a column of time in seconds, which a tracker tells by its rate alone.
TIME = "time"
_DELIMITERS = "\t,;"


def rows_of_export(path: Path) -> list[list[str]]:
    """All lines of an export as cells (stripped), blank lines as none; the delimiter is the most frequent one.

    Raises:
        DataError: it is no text.
    """
    text, _ = decoded(path.read_bytes(), is_whole=True)
    delimiter = max(_DELIMITERS, key=text.count)
    rows = [[cell.strip() for cell in row] for row in csv.reader(text.splitlines(), delimiter=delimiter)]
    return [row if any(row) else [] for row in rows]


def frames_table(
    names: Sequence[str], units: Sequence[str], frames: Sequence[Sequence[str]], first_line: int, rate: float | None
) -> MemoryTable:
    """The table of frames; an empty cell and a marker that is not seen are gaps.

    Parameters:
        names: of the columns, the first that of the number of a frame; an empty one is left out.
        units: of the columns.
        frames: their cells; rows may be shorter or longer.
        first_line: the line (from 1) of the first frame.
        rate: frames per second, which gives a column `time`; None where it is not told.
    """
    kept = [place for place, name in enumerate(names) if name]
    columns = [_column([row[place] if place < len(row) else "" for row in frames]) for place in kept]
    called, told = [names[place] for place in kept], [units[place] if place < len(units) else "" for place in kept]
    if rate and columns and columns[0].dtype != object:
        called.insert(1, TIME)
        told.insert(1, "s")
        columns.insert(1, (columns[0] - 1) / rate)
    return MemoryTable(tuple(called), tuple(columns), lambda row: f"line {first_line + row}", tuple(told))


def _column(cells: Sequence[str]) -> NDArray[np.object_] | NDArray[np.float64]:
    """Numbers, NaN where there is none, or the cells where one of them is something else."""
    try:
        values = np.array([float(cell) if cell else np.nan for cell in cells], dtype=np.float64)
    except ValueError:
        texts = np.empty(len(cells), dtype=object)
        texts[:] = list(cells)
        return texts
    values[values < NOT_SEEN] = np.nan
    return values
