"""Whether a result file is damaged: cut off, or something else than its name says."""

from __future__ import annotations

import csv
import os
import struct
import zipfile
import zlib
from collections.abc import Callable, Iterable
from pathlib import Path

from softkin.core.errors import DataError
from softkin.core.strict_json import parse_json

#: What readers raise on garbage.
_UNREADABLE = (
    *(OSError, ValueError, EOFError, KeyError, IndexError, TypeError, AttributeError, ImportError, MemoryError),
    *(zipfile.BadZipFile, zlib.error, struct.error, csv.Error, AssertionError, RecursionError),
)
#: Written whole, these end with a line break.
_LINES = (".csv", ".json", ".tsv")
RESULTS = "results"
CHUNK_BYTES = 1 << 20


def check_ends(paths: Iterable[str | os.PathLike[str]]) -> None:
    """Check that results of lines (CSV, JSON) are not cut off: pandas reads half a table without a word.

    Raises:
        DataError: the first that is empty, or whose last line has no end.
    """
    for path in map(Path, paths):
        if path.suffix in _LINES and path.parts[0] == RESULTS and path.is_file():
            with path.open("rb") as file:
                file.seek(max(0, path.stat().st_size - 1))
                if file.read(1) != b"\n":
                    raise damaged(path, "it is cut off or empty")


def first_damage(paths: Iterable[str | os.PathLike[str]]) -> DataError | None:
    """The error of the first damaged file among `paths`; None where all are whole, as far as their kind is known."""
    for path in map(Path, paths):
        kind, check = _CHECKS.get(path.suffix, ("", None))
        if path.is_file() and check is not None:
            try:
                check(path)
            except _UNREADABLE as error:
                return damaged(path, kind or " ".join(str(error).split())[:200])
    return None


def damaged(path: str | os.PathLike[str], reason: str) -> DataError:
    """The error that a result file cannot be used."""
    return DataError(
        f"this result is damaged: {reason}",
        where=path,
        fix="delete the file and run again; what made it runs anew, all else that is finished is kept",
    )


def _table(path: Path) -> None:
    with path.open(encoding="utf-8", newline="") as file:
        rows = csv.reader(file, delimiter="\t" if path.suffix == ".tsv" else ",", strict=True)
        width = len(next(rows, []))
        for row in rows:
            if len(row) != width:
                raise ValueError(f"line {rows.line_num} has {len(row)} values, the header {width}")
    if not width:
        raise ValueError("it is empty")


def _json(path: Path) -> None:
    parse_json(path.read_text(encoding="utf-8"))


def _parquet(path: Path) -> None:
    import pyarrow.parquet as pq

    pq.read_table(path)


def _archive(path: Path) -> None:
    import numpy as np

    with np.load(path) as stored:
        for name in stored:
            stored[name]


def _model(path: Path) -> None:
    """Unpack a model to its end, which has a checksum; nothing is unpickled, since that runs what is in it."""
    packed = zlib.decompressobj()
    with path.open("rb") as file:
        while waiting := file.read(CHUNK_BYTES):
            while waiting:
                packed.decompress(waiting, CHUNK_BYTES)
                waiting = packed.unconsumed_tail
    if not packed.eof or packed.unused_data:
        raise EOFError("it is cut off, or something stands behind its end")


#: Ending of a name -> what to say, where the reader's own words would not help, and how to read the whole file.
_CHECKS: dict[str, tuple[str, Callable[[Path], None]]] = {
    ".csv": ("", _table),
    ".tsv": ("", _table),
    ".json": ("", _json),
    ".parquet": ("it is no whole Parquet file", _parquet),
    ".npz": ("it is no whole archive of arrays", _archive),
    ".joblib": ("it holds no whole model", _model),
}
