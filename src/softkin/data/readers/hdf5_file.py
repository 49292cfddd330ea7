"""Arrays of an HDF5 file: MATLAB's from v7.3 on, or any other. It needs h5py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import Table
from softkin.data.readers.named_arrays import table_of_variables
from softkin.data.readers.optional_library import library

FIRST_BYTES = (b"MATLAB 7.3", b"\x89HDF")
#: Of MATLAB's file, what is no variable.
_REFERENCES = "#refs#"


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
    """The table of the arrays; groups and structs give their fields, trials a column `session` that numbers them.

    Raises:
        DataError: h5py is not installed, or the file is damaged, or trials have different fields.
    """
    h5py = library(
        "h5py", "an HDF5 file, as MATLAB writes from v7.3 on", "write it with save('robot.mat', '-v7') in MATLAB"
    )
    try:
        with h5py.File(path, "r") as file:
            variables = _group(file, file)
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, RecursionError) as error:
        raise DataError(f"not readable as HDF5: {error}", fix="write the file anew") from error
    return table_of_variables(variables)


def _group(group: Any, file: Any) -> Any:
    """A dictionary of a group's members; a list of dictionaries of MATLAB's array of structs."""
    fields = {name: _value(member, file) for name, member in group.items() if name != _REFERENCES}
    columns = [value for value in fields.values() if isinstance(value, list)]
    is_array = bool(columns) and len(columns) == len(fields) and len({len(column) for column in columns}) == 1
    if _kind(group) == "struct" and is_array:
        return [dict(zip(fields, values, strict=True)) for values in zip(*fields.values(), strict=True)]
    return fields


def _value(member: Any, file: Any) -> Any:
    """What a member of a group holds: a dictionary, an array, a text, or the list of what its references lead to."""
    if hasattr(member, "items"):
        return _group(member, file)
    kind, array = _kind(member), np.asarray(member[()])
    if array.dtype == object and array.size and isinstance(array.flat[0], bytes):
        texts = [text.decode("utf-8", "replace") for text in array.flat]
        return np.array(texts, dtype=object).reshape(array.shape)
    if array.dtype == object and array.size:
        return [_value(file[reference], file) for reference in array.ravel()]
    if kind == "char":
        return "".join(map(chr, array.T.ravel()))
    if kind and member.attrs.get("MATLAB_empty", 0):
        return np.empty(0)
    return np.squeeze(array.T) if kind else array


def _kind(member: Any) -> str:
    """What MATLAB says a variable is; empty where the file is not MATLAB's."""
    kind = member.attrs.get("MATLAB_class", b"")
    return kind.decode() if isinstance(kind, bytes) else str(kind)
