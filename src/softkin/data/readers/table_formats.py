"""Kinds of files that hold a robot's own table, and what their first bytes are. One file a kind, one line here."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError
from softkin.data.readers import (
    c3d_file,
    delimited_text,
    excel_workbook,
    feather_file,
    file_bundle,
    hdf5_file,
    json_records,
    matlab_file,
    motive_export,
    ndi_export,
    numpy_file,
    parquet_columns,
    several_files,
    vicon_export,
)
from softkin.data.readers.memory_table import Table
from softkin.data.readers.stamped_table import stamped
from softkin.data.readers.text_encoding import in_utf8


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
    """An object, or a list of objects, lists of names or numbers, or nothing; a row of text may begin with a list."""
    return bool(re.match(rb"(\xef\xbb\xbf)?\s*(\{\s*[\"}]|\[\s*([{\]]|\[\s*(\"|-?[\d.]+([eE][-+]?\d+)?\s*,)))", start))


def _open_several(path: Path, source: Mapping[str, Any]) -> Table:
    return several_files.open_table(path, source, open_table)


#: The first that a file is of counts; text is what is nothing else.
TABLE_FORMATS: dict[str, TableFormat] = {
    "files": TableFormat(file_bundle.is_bundle, _open_several),
    "parquet": TableFormat(begins_with(b"PAR1"), parquet_columns.open_table),
    "feather": TableFormat(begins_with(*feather_file.FIRST_BYTES), feather_file.open_table),
    "numpy": TableFormat(_is_of_numpy, numpy_file.open_table),
    "excel": TableFormat(excel_workbook.is_workbook, excel_workbook.open_table),
    "hdf5": TableFormat(begins_with(*hdf5_file.FIRST_BYTES), hdf5_file.open_table),
    "matlab": TableFormat(begins_with(b"MATLAB"), matlab_file.open_table),
    "json": TableFormat(_is_json, json_records.open_table),
    "c3d": TableFormat(c3d_file.is_c3d, c3d_file.open_table),
    "vicon": TableFormat(vicon_export.is_export, vicon_export.open_table),
    "ndi": TableFormat(begins_with(*ndi_export.FIRST_WORDS), ndi_export.open_table),
    "motive": TableFormat(begins_with(*motive_export.FIRST_WORDS), motive_export.open_table),
    "text": TableFormat(lambda _: True, delimited_text.open_table),
}
#: How a pickle begins: of protocol 2 and later, of 0 and 1.
_PICKLE = re.compile(rb"\x80[\x02-\x05]|\(?(c[\w.]+\n\w+\n|[dl]p\d+\n|[\]})]q\x00)|[\]})]q\x00")
#: Of files that people take for tables: how they begin, what they are, and how to get a table; {name} is the file's.
NO_TABLES: tuple[tuple[re.Pattern[bytes], str, str], ...] = (
    (re.compile(rb"PK\x03\x04"), "a zip file", "unpack it"),
    (re.compile(rb"\x1f\x8b"), "compressed by gzip", "unpack it"),
    (
        _PICKLE,
        "a pickle, which may run any program when it is opened",
        "convert it where you trust it, by two lines of Python:\n    import pandas\n"
        "    pandas.DataFrame(pandas.read_pickle('{name}')).to_parquet('{stem}.parquet')",
    ),
)
FIRST_BYTES = 4096


def open_table(path: str | Path, source: Mapping[str, Any]) -> Table:
    """The table in a file; its first bytes decide what it is, not its name. `source` is its entry.

    Raises:
        DataError: the file is none that can be read, or is empty, or has no header.
    """
    with open(path, "rb") as file:
        start = in_utf8(file.read(FIRST_BYTES))
    name, kind = next((name, kind) for name, kind in TABLE_FORMATS.items() if kind.is_of(start))
    for begins, what, fix in NO_TABLES:
        if name == "text" and begins.match(start):
            named = Path(source.get("file", path))
            raise DataError(f"no table, but {what}", fix=fix.format(name=named.name, stem=named.stem))
    table = kind.open_table(Path(path), source)
    return table if name == "files" else stamped(table)
