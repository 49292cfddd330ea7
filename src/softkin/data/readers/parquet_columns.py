"""Columns of a Parquet file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softkin.data.readers.arrow_columns import ArrowColumns, unreadable
from softkin.data.readers.memory_table import Table


def open_parquet(path: Path) -> ArrowColumns:
    """The columns of the Parquet file `path`.

    Raises:
        DataError: the file is damaged.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        names = pq.read_schema(path).names
    except (pa.ArrowException, OSError) as error:
        raise unreadable("Parquet", error) from error
    return ArrowColumns(tuple(names), lambda columns: pq.read_table(path, columns=columns), "Parquet")


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
    """The same, whatever the entry says."""
    return open_parquet(path)
