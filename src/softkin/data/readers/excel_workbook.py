"""A sheet of an Excel or OpenDocument workbook. It is read as the text that Excel would save it as."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError
from softkin.data.readers.delimited_text import open_text, with_lists
from softkin.data.readers.memory_table import Table


def is_workbook(start: bytes) -> bool:
    """Whether a file begins as a workbook does: the old format, or a zip file with the members of one."""
    names = (b"[Content_Types].xml", b"xl/", b"_rels/", b"docProps/", b"mimetypeapplication/vnd.oasis.opendocument")
    is_zip = start.startswith(b"PK\x03\x04") and any(start[30:].startswith(name) for name in names)
    return is_zip or start.startswith(b"\xd0\xcf\x11\xe0")


def open_table(path: Path, source: Mapping[str, Any]) -> Table:
    """The table in the sheet that the key `sheet` of the entry names, or in the only one that is not empty; lines of
    messages are rows of the sheet. The key `header` counts as for text.

    Raises:
        DataError: damaged, no such sheet, several where none is named, or no table in it.
    """
    import python_calamine

    try:
        workbook = python_calamine.load_workbook(str(path))
        sheets = {
            name: workbook.get_sheet_by_name(name).to_python(skip_empty_area=False) for name in workbook.sheet_names
        }
    except (python_calamine.CalamineError, OSError) as error:
        raise DataError(
            f"not readable as a workbook: {error}", fix="open it and save the sheet as 'CSV UTF-8'"
        ) from error
    name = _chosen({name: rows for name, rows in sheets.items() if any(map(_is_filled, rows))}, source.get("sheet"))
    try:
        text = open_text(path, ",", source.get("header"), _as_text(sheets[name]))
        return with_lists(replace(text, called=source.get("file", "")))
    except DataError as error:
        raise error.within(f"sheet '{name}'") from error


def _chosen(filled: Mapping[str, Any], wanted: str | None) -> str:
    """The name of the sheet, of those that hold something."""
    if not filled:
        raise DataError("no sheet holds rows", fix="export it again, with a header and rows of numbers")
    listed = ", ".join(filled)
    if wanted is not None and wanted not in filled:
        raise DataError(f"no sheet '{wanted}' that holds rows; those are: {listed}", where="`sheet`", fix="name one")
    if wanted is None and len(filled) != 1:
        what = f"{len(filled)} sheets hold rows: {listed}"
        raise DataError(what, fix="write the name of one as `sheet` of the entry (make new-robot SHEET=...)")
    return wanted if wanted is not None else next(iter(filled))


def _as_text(rows: Sequence[Sequence[Any]]) -> bytes:
    """The rows as CSV, numbers with all their digits; columns and rows without any value are left blank or out."""
    places = [place for place in range(max(map(len, rows))) if any(_is_filled(row[place : place + 1]) for row in rows)]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for row in rows:
        cells = [_as_cell(row[place]) if place < len(row) else "" for place in places]
        if any(cells):
            writer.writerow(cells)
        else:
            text.write("\n")
    return text.getvalue().encode()


def _as_cell(value: Any) -> str:
    if isinstance(value, float):
        return repr(int(value)) if value.is_integer() and abs(value) < 2**53 else repr(value)
    return value.isoformat() if hasattr(value, "isoformat") else " ".join(str(value).split())


def _is_filled(row: Sequence[Any]) -> bool:
    return any(value is not None and str(value).strip() for value in row)
