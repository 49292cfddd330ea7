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


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
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
        raise DataError(
            f"not readable as arrays of numpy: {error}",
            fix="store plain arrays of numbers by numpy.savez, one row per pose",
        ) from error
    return table_of_arrays(arrays)
