"""A table of named arrays: those with one entry per row, each other axis spread over columns."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import MemoryTable


def table_of_arrays(arrays: Mapping[str, NDArray[Any]]) -> MemoryTable:
    """The table of all arrays (n_rows, ...) of numbers or text whose first axis is as long as most are.

    An array `p` of three numbers per row becomes `p_1`, `p_2`, `p_3`, or `p_x`, ... where its name says position.

    Raises:
        DataError: no array has rows; lists all with their shapes.
    """
    usable = {name: array for name, array in arrays.items() if array.ndim and array.dtype.kind in "fiubUO"}
    lengths = Counter(len(array) for array in usable.values() if len(array) > 1)
    if not lengths:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items()) or "none"
        raise DataError(f"no array has a row per pose: {shapes}", fix="store arrays with one row per pose")
    n_rows = lengths.most_common(1)[0][0]
    names: list[str] = []
    columns: list[NDArray[Any]] = []
    for name, array in usable.items():
        if len(array) != n_rows:
            continue
        flat = array.reshape(n_rows, -1)
        flat = flat.astype(np.float64) if array.dtype.kind in "fiu" else flat.astype(object)
        names += _names(name, array.shape[1:])
        columns += list(flat.T)
    return MemoryTable(tuple(names), tuple(columns))


def _names(name: str, shape: tuple[int, ...]) -> list[str]:
    """Names of the columns of an array of this shape per row."""
    sizes = [size for size in shape if size > 1]
    if not sizes:
        return [name]
    if name.lower().startswith(("pos", "tip", "marker")) and sizes[-1] == 3 and len(sizes) <= 2:
        markers = [""] if len(sizes) == 1 else [str(place + 1) for place in range(sizes[0])]
        return [f"{name}{marker}_{axis}" for marker in markers for axis in "xyz"]
    return [f"{name}_{place + 1}" for place in range(int(np.prod(sizes)))]
