"""Kinds of files that hold a robot's own table, and what their first bytes are. One file a kind, one line here."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError
from softkin.data.readers import delimited_text, json_records, matlab_file, motive_export, numpy_file, parquet_columns
from softkin.data.readers.memory_table import Table


@dataclass(frozen=True, slots=True)
class TableFormat:
    """A kind of file: whether the first bytes of a file are of this kind, and open_table(path, source) of its table."""

    is_of: Callable[[bytes], bool]
    open_table: Callable[[Path, Mapping[str, Any]], Table]


def begins_with(*magic: bytes) -> Callable[[bytes], bool]:
    """Whether a file begins with one of these bytes."""
    return lambda start: start.startswith(magic)


def _is_of_numpy(start: bytes) -> bool:
    """NPY, or a zip file whose first member is one."""
    return start.startswith(b"\x93NUMPY") or (start.startswith(b"PK\x03\x04") and b".npy" in start[:300])


def _is_json(start: bytes) -> bool:
    """An object, or a list of objects or nothing; a row of text may begin with a list."""
    return bool(re.match(rb"(\xef\xbb\xbf)?\s*(\{\s*[\"}]|\[\s*[{\]])", start))


#: The first that a file is of counts; text is what is nothing else.
TABLE_FORMATS: dict[str, TableFormat] = {
    "parquet": TableFormat(begins_with(b"PAR1"), parquet_columns.open_table),
    "numpy": TableFormat(_is_of_numpy, numpy_file.open_table),
    "matlab": TableFormat(begins_with(b"MATLAB"), matlab_file.open_table),
    "json": TableFormat(_is_json, json_records.open_table),
    "motive": TableFormat(begins_with(*motive_export.FIRST_WORDS), motive_export.open_table),
    "text": TableFormat(lambda _: True, delimited_text.open_table),
}
#: First bytes of files that people take for tables -> what they are, and how to get a table.
NO_TABLES = {
    b"PK\x03\x04": ("an Excel workbook or a zip file", "open it and save the sheet as 'CSV UTF-8'"),
    b"\xd0\xcf\x11\xe0": ("an old Excel workbook", "open it and save the sheet as 'CSV UTF-8'"),
    b"\x1f\x8b": ("compressed by gzip", "unpack it"),
    b"\x89HDF": ("an HDF5 file", "export the table as CSV or Parquet"),
    b"\x80": (
        "a pickle, which may run any program when it is opened",
        "convert it where you trust it: import pandas; pandas.read_pickle('robot.pkl').to_parquet('robot.parquet')",
    ),
}
FIRST_BYTES = 4096


def open_table(path: str | Path, source: Mapping[str, Any]) -> Table:
    """The table in a file; its first bytes decide what it is, not its name. `source` is its entry.

    Raises:
        DataError: the file is none that can be read, or is empty, or has no header.
    """
    with open(path, "rb") as file:
        start = file.read(FIRST_BYTES)
    name, kind = next((name, kind) for name, kind in TABLE_FORMATS.items() if kind.is_of(start))
    for magic, (what, fix) in NO_TABLES.items():
        if name == "text" and start.startswith(magic):
            raise DataError(f"no table, but {what}", fix=fix)
    return kind.open_table(Path(path), source)
