"""Records in JSON: a list of objects, one object to a line, an object of columns, or what pandas writes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import Table, from_cells
from softkin.data.readers.nested_values import columns_of
from softkin.data.readers.published_json import SUBSET_KEYS
from softkin.data.readers.text_encoding import decoded


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
    """The table of the records; a value that is missing is a gap, a list becomes several columns.

    Raises:
        DataError: no JSON, a key twice in an object, or neither records nor columns of equal length.
    """
    text, _ = decoded(path.read_bytes(), is_whole=True)
    try:
        try:
            content = json.loads(text, object_pairs_hook=_unique)
        except json.JSONDecodeError:
            content = [_record(line, number) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    except (ValueError, RecursionError) as error:
        raise DataError(f"not readable as JSON: {error}", fix="write the file anew") from error
    if isinstance(content, dict) and set(SUBSET_KEYS.values()) <= set(content):
        raise DataError(
            "the layout of the published files, kinn_json",
            fix="write that as `format` of the entry, with `n_commands` and `n_markers`",
        )
    columns = columns_of(content)
    if len({len(column) for column in columns.values()}) > 1:
        lengths = ", ".join(f"{name} {len(column)}" for name, column in columns.items())
        raise DataError(f"columns of different length: {lengths}", fix="write one value per row in each column")
    return from_cells([str(name) for name in columns], list(columns.values()))


def _record(line: str, number: int) -> Any:
    try:
        return json.loads(line, object_pairs_hook=_unique)
    except json.JSONDecodeError as error:
        raise ValueError(f"line {number}: {error.msg}") from error


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object, whose keys stand once each."""
    value = dict(pairs)
    if len(value) < len(pairs):
        keys = [key for key, _ in pairs]
        raise ValueError(f"the key '{next(key for key in keys if keys.count(key) > 1)}' stands twice in one object")
    return value
