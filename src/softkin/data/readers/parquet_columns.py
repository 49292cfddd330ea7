"""Columns of a Parquet file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softkin.data.readers.arrow_columns import ArrowColumns, spread, unreadable
from softkin.data.readers.memory_table import Table


def open_parquet(path: Path) -> Table:
    """The columns of the Parquet file `path`.

    Raises:
        DataError: the file is damaged.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        schema = pq.read_schema(path)
    except (pa.ArrowException, OSError) as error:
        raise unreadable("Parquet", error) from error
    columns = ArrowColumns(tuple(schema.names), lambda names: pq.read_table(path, columns=names), "Parquet")
    return spread(columns, schema)


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
    """The same, whatever the entry says."""
    return open_parquet(path)
