"""Variables of a MATLAB file up to v7: arrays, a struct of them, or a struct for each trial: these become sessions."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import Table
from softkin.data.readers.named_arrays import table_of_variables


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
    """The table of the variables; structs give their fields, trials a column `session` that numbers them.

    Raises:
        DataError: damaged, or trials with different fields.
    """
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        variables = loadmat(path, simplify_cells=True)
    except (
        MatReadError,
        zlib.error,
        LookupError,
        ValueError,
        TypeError,
        NotImplementedError,
        OSError,
        EOFError,
    ) as error:
        raise DataError(f"not readable as MATLAB: {error}", fix="save it anew with save('robot.mat', '-v7')") from error
    return table_of_variables({name: value for name, value in variables.items() if not name.startswith("__")})
