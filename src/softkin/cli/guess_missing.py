"""What of a robot's own table is missing, and the key `missing` of its entry: cells without a number, markers that a
tracker lost.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.data.readers.complete_rows import DROP_ROWS, lost_markers
from softkin.data.readers.memory_table import Table

MISSING = {"missing": DROP_ROWS}


def values_of(
    table: Table, commands: Sequence[str], positions: Sequence[str], dimensions: int, looked: Mapping[str, Any]
) -> tuple[Array, Array, dict[str, str], list[str]]:
    """Commands (n_rows, n_commands) and positions (n_rows, n_coordinates) of the rows that hold all numbers, the key
    `missing` where others do not, and why; of the rows that were `looked` at where the file cannot be read to its end.

    Raises:
        DataError: no row holds all numbers.
    """
    names = [*commands, *positions]
    places = [table.names.index(name) for name in names]
    try:
        values, _ = table.read(places, [], gaps=True)
        missing, why = MISSING, ""
    except DataError as error:
        seen = [looked[name] if looked[name].dtype != object else np.full(len(looked[name]), np.nan) for name in names]
        values, missing = np.column_stack(seen), {}
        n_good = int((~np.isnan(values).any(axis=1)).sum())
        if not n_good:
            raise error
        why = f"guessed from {n_good} rows, since the file is not readable to its end"
    unjoined = getattr(table, "unjoined", None)  # rows without a partner in another file are left out anyway
    values = values if unjoined is None or why else values[~unjoined]
    is_lost = lost_markers(values[:, len(commands) :], dimensions).any(axis=1)
    has_gap = np.isnan(values).any(axis=1)
    whole = values[~has_gap & ~is_lost]
    if not why and len(whole) == len(values):
        missing = {}
    elif not why:
        lost = f", {int(is_lost.sum())} of them since a marker stands where its tracker puts it when lost"
        count = len(values) - len(whole)
        why = f"missing: {count} of {len(values)} rows lack a number{lost * bool(is_lost.any())} and are left out"
        why += "; please check"
    return whole[:, : len(commands)], whole[:, len(commands) :], dict(missing), [why] if why else []
