"""Records in JSON: a list of objects, one object to a line, or an object of columns."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import Table, from_cells
from softkin.data.readers.published_json import SUBSET_KEYS


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
    """The table of the records; a value that is missing is a gap, a list becomes several columns.

    Raises:
        DataError: no JSON, or neither records nor columns of equal length.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
        try:
            content = json.loads(text)
        except json.JSONDecodeError:
            content = [_record(line, number) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    except (ValueError, RecursionError) as error:
        raise DataError(f"not readable as JSON: {error}", fix="write the file anew") from error
    if isinstance(content, dict) and set(SUBSET_KEYS.values()) <= set(content):
        raise DataError(
            "the layout of the published files, kinn_json",
            fix="write that as `format` of the entry, with `n_commands` and `n_markers`",
        )
    if isinstance(content, dict) and content and all(isinstance(column, list) for column in content.values()):
        columns = content
    elif isinstance(content, list) and content and all(isinstance(record, dict) for record in content):
        names = list(dict.fromkeys(name for record in content for name in record))
        columns = {name: [record.get(name) for record in content] for name in names}
    else:
        raise DataError("neither records nor columns", fix='write a list of records, such as [{"u1": 1, "x": 2}, ...]')
    if len({len(column) for column in columns.values()}) > 1:
        lengths = ", ".join(f"{name} {len(column)}" for name, column in columns.items())
        raise DataError(f"columns of different length: {lengths}", fix="write one value per row in each column")
    return from_cells(list(columns), list(columns.values()))


def _record(line: str, number: int) -> Any:
    try:
        return json.loads(line)
    except json.JSONDecodeError as error:
        raise ValueError(f"line {number}: {error.msg}") from error
