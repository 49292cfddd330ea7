"""Arrays that numpy wrote: NPZ, and NPY of one table."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import Table
from softkin.data.readers.named_arrays import table_of_arrays

_FIX = "convert it where you trust it, by two lines of Python:\n    import numpy\n    "


def open_table(path: Path, source: Mapping[str, Any]) -> Table:
    """The table of the arrays in the file; one array alone has the columns c_1, c_2, ...

    Raises:
        DataError: damaged, or an array holds Python objects, which are never unpickled.
    """
    try:
        stored = np.load(path, allow_pickle=False)
        if isinstance(stored, np.ndarray):
            arrays = {name: stored[name] for name in stored.dtype.names} if stored.dtype.names else {"c": stored}
        else:
            arrays = {name: stored[name] for name in stored.files}
    except (ValueError, OSError, EOFError, zipfile.BadZipFile) as error:
        if "allow_pickle" in str(error):
            raise _of_objects(path, Path(source.get("file", path)).name) from error
        raise DataError(
            f"not readable as arrays of numpy: {error}",
            fix="store plain arrays of numbers by numpy.savez, one row per pose",
        ) from error
    return table_of_arrays(arrays)


def _of_objects(path: Path, called: str) -> DataError:
    """That a file holds Python objects, and how to make arrays of them: of a dictionary alone its values, else of each
    array its rows.
    """
    load = f"numpy.load('{called}', allow_pickle=True)"
    dictionary = _only_object(path)
    if dictionary is None:
        line = f"data = {load}; numpy.savez('plain.npz', **{{name: numpy.array(data[name].tolist()) for name in data}})"
    else:
        inner = f"['{dictionary}']" if dictionary else ""
        line = f"numpy.savez('plain.npz', **{load}{inner}.item())"
    what = "arrays of Python objects, which may run any program when they are opened"
    return DataError(what, fix=_FIX + line)


def _only_object(path: Path) -> str | None:
    """The name of the array in the file whose only value is an object, such as a dictionary, and empty of NPY; None
    where there is none.
    """
    if not zipfile.is_zipfile(path):
        with path.open("rb") as file:
            return "" if _shape(file) == () else None
    with zipfile.ZipFile(path) as archive:
        for member in archive.namelist():
            with archive.open(member) as file:
                if _shape(file) == ():
                    return member.removesuffix(".npy")
    return None


def _shape(file: Any) -> tuple[int, ...] | None:
    """The shape of the array of objects that a file of numpy begins with; None of any other array."""
    version = np.lib.format.read_magic(file)
    reads = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, _, kind = reads(file)
    return tuple(shape) if kind.hasobject else None
