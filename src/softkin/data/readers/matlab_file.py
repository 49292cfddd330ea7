"""Variables of a MATLAB file up to v7: arrays, a struct of them, or a struct for each trial: these become sessions."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import Table
from softkin.data.readers.named_arrays import table_of_arrays

VERSION_7_3 = b"MATLAB 7.3"


def open_table(path: Path, _source: Mapping[str, Any]) -> Table:
    """The table of the variables; structs give their fields, trials a column `session` that numbers them.

    Raises:
        DataError: damaged, of v7.3, or trials with different fields.
    """
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    if path.read_bytes()[: len(VERSION_7_3)] == VERSION_7_3:
        raise DataError("a MATLAB file of v7.3", fix="write it with save('robot.mat', '-v7') in MATLAB")
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
    arrays: dict[str, NDArray[Any]] = {}
    for name, value in variables.items():
        if name.startswith("__"):
            continue
        trials = _trials(value)
        if trials:
            arrays |= _joined(trials, name)
        else:
            arrays |= _fields(value) if isinstance(value, dict) else {name: np.asarray(value)}
    return table_of_arrays(arrays)


def _fields(struct: Mapping[str, Any]) -> dict[str, NDArray[Any]]:
    return {field: np.asarray(value) for field, value in struct.items() if not isinstance(value, dict)}


def _trials(value: Any) -> list[dict[str, Any]]:
    """The structs of an array of structs, one per trial; none of anything else."""
    cells = list(value) if isinstance(value, list | np.ndarray) and np.ndim(value) == 1 else []
    return cells if cells and all(isinstance(cell, dict) for cell in cells) else []


def _joined(trials: list[dict[str, Any]], name: str) -> dict[str, NDArray[Any]]:
    """Fields of all trials, one below the other, and the session of each row."""
    parts = [_fields(trial) for trial in trials]
    if len({tuple(part) for part in parts}) > 1:
        raise DataError("trials have different fields", where=f"variable '{name}'", fix="give all trials the same")
    rows = [max(len(array) for array in part.values() if array.ndim) for part in parts]
    whole = [
        field
        for field in parts[0]
        if all(p[field].ndim and len(p[field]) == n for p, n in zip(parts, rows, strict=True))
    ]
    joined = {field: np.concatenate([part[field] for part in parts]) for field in whole}
    return {"session": np.repeat(np.arange(1, len(parts) + 1), rows)} | joined
