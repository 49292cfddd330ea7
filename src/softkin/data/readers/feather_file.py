"""Columns of a Feather file, which is an Arrow file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softkin.data.readers.arrow_columns import ArrowColumns, spread, unreadable
from softkin.data.readers.memory_table import Table

FIRST_BYTES = (b"ARROW1", b"FEA1")


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
    """The columns of the Feather file `path`, of either version.

    Raises:
        DataError: the file is damaged.
    """
    import pyarrow as pa
    from pyarrow import feather

    try:
        schema = feather.read_table(path, memory_map=True).schema
    except (pa.ArrowException, OSError) as error:
        raise unreadable("Feather", error) from error
    columns = ArrowColumns(tuple(schema.names), lambda names: feather.read_table(path, columns=names), "Feather")
    return spread(columns, schema)
