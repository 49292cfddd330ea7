"""A table of named arrays: those with one entry per row, each other axis spread over columns; trials are sessions."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.data.readers.memory_table import MemoryTable

logger = logging.getLogger("softkin")

#: The column that numbers the trials of a file.
SESSION = "session"


def table_of_variables(variables: Mapping[str, Any]) -> MemoryTable:
    """The table of the variables of a file: arrays, a struct (dictionary) of them, or trials: an array of structs, or
    several structs of the same fields. Trials stand one below the other, and a column `session` numbers them from 1.

    Raises:
        DataError: trials have different fields, or no array has rows.
    """
    arrays: dict[str, NDArray[Any]] = {}
    variables = _unwrapped(variables)
    structs = {name: value for name, value in variables.items() if isinstance(value, dict)}
    are_trials = len(structs) > 1 and len({tuple(sorted(struct)) for struct in structs.values()}) == 1
    if are_trials:
        logger.info("trials, in this order: %s", ", ".join(structs))
        arrays |= _joined(list(structs.values()), " ".join(structs))
    for name, value in variables.items():
        trials = _trials(value)
        if trials:
            arrays |= _joined(trials, name)
        elif isinstance(value, dict) and not are_trials:
            fields = _fields(value)
            arrays |= {f"{name}_{field}" if field in arrays else field: array for field, array in fields.items()}
        elif not isinstance(value, dict):
            arrays[name] = np.asarray(value, dtype=object) if isinstance(value, list) else np.asarray(value)
    return table_of_arrays(arrays)


def table_of_arrays(arrays: Mapping[str, NDArray[Any]]) -> MemoryTable:
    """The table of all arrays (n_rows, ...) of numbers or text whose first axis is as long as most are.

    An array `p` of three numbers per row becomes `p_1`, `p_2`, `p_3`, or `p_x`, ... where its name says position.
    Arrays whose rows stand along their last axis are turned; of trials by rows, all of one shape, a column `session`
    numbers the trials.

    Raises:
        DataError: no array has rows; lists all with their shapes.
    """
    usable = {name: array for name, array in _fields_of(arrays).items() if array.dtype.kind in "fiubUO" and array.ndim}
    usable, lengths = _by_trials(usable), Counter(size for array in usable.values() for size in {*array.shape} - {1, 0})
    if not lengths:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items()) or "none"
        raise DataError(f"no array has a row per pose: {shapes}", fix="store arrays with one row per pose")
    if SESSION in usable and SESSION not in arrays:
        n_rows = len(usable[SESSION])
    else:
        n_rows = max(lengths, key=lambda size: (lengths[size], size))
    usable = {name: _turned(name, array, n_rows) for name, array in usable.items()}
    left = [
        f"{name} {array.shape}"
        for name, array in arrays.items()
        if len(usable.get(name, ())) != n_rows and not array.dtype.names
    ]
    if left:
        logger.log(
            logging.WARNING if _hold_rows(arrays, left) else logging.INFO,
            "arrays of %d rows are read; left out: %s",
            n_rows,
            ", ".join(left),
        )
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


def _unwrapped(variables: Mapping[str, Any]) -> dict[str, Any]:
    """The variables, structs within structs brought up: `exp.data.u` becomes `data.u` of the struct `exp`."""
    found: dict[str, Any] = {}
    for name, value in variables.items():
        inner = {key: part for key, part in value.items() if isinstance(part, dict)} if isinstance(value, dict) else {}
        if not inner:
            found[name] = value
            continue
        own = {key: part for key, part in value.items() if key not in inner}
        found |= {name: own} if own else {}
        found |= {key if key not in variables else f"{name}_{key}": part for key, part in _unwrapped(inner).items()}
    return found


def _fields_of(arrays: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """The arrays, each field of one with named fields as an array of its own."""
    found: dict[str, NDArray[Any]] = {}
    for name, array in arrays.items():
        for field in array.dtype.names or ("",):
            found[field if field and field not in arrays else name] = array[field] if field else array
    return found


def _by_trials(arrays: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """The arrays; where all begin with as many trials and rows, these rows one below the other, and their trial."""
    shapes = {array.shape[:2] for array in arrays.values()}
    if len(arrays) < 2 or len(shapes) > 1 or not all(array.ndim == 3 for array in arrays.values()):
        return dict(arrays)
    (n_trials, n_rows) = next(iter(shapes))
    if n_rows <= max(n_trials, *(array.shape[2] for array in arrays.values())):
        return dict(arrays)
    logger.info("%d trials of %d rows", n_trials, n_rows)
    stacked = {name: array.reshape(n_trials * n_rows, -1) for name, array in arrays.items()}
    return {SESSION: np.repeat(np.arange(1, n_trials + 1), n_rows)} | stacked


def _turned(name: str, array: NDArray[Any], n_rows: int) -> NDArray[Any]:
    """The array with its rows along the first axis, where they are along the last one alone."""
    if len(array) == n_rows or array.shape[-1] != n_rows:
        return array
    logger.info("%s %s is turned: its rows stand along the last axis", name, array.shape)
    return array.T


def _hold_rows(arrays: Mapping[str, NDArray[Any]], left: Sequence[str]) -> bool:
    """Whether some of those that are `left` out are tables of numbers, too, such as a test set."""
    named = {told.split(" (")[0] for told in left}
    return any(
        array.ndim > 1 and array.dtype.kind in "fiu" and len(array) > 1 for n, array in arrays.items() if n in named
    )


def _names(name: str, shape: tuple[int, ...]) -> list[str]:
    """Names of the columns of an array of this shape per row."""
    sizes = [size for size in shape if size > 1]
    if not sizes:
        return [name]
    if name.lower().startswith(("pos", "tip", "marker")) and sizes[-1] == 3 and len(sizes) <= 2:
        markers = [""] if len(sizes) == 1 else [str(place + 1) for place in range(sizes[0])]
        return [f"{name}{marker}_{axis}" for marker in markers for axis in "xyz"]
    return [f"{name}_{place + 1}" for place in range(int(np.prod(sizes)))]


def _fields(struct: Mapping[str, Any]) -> dict[str, NDArray[Any]]:
    return {field: np.asarray(value) for field, value in struct.items() if not isinstance(value, dict)}


def _trials(value: Any) -> list[dict[str, Any]]:
    """The structs of an array of structs, one per trial; none of anything else."""
    cells = list(value) if isinstance(value, list | np.ndarray) and np.ndim(value) == 1 else []
    return cells if cells and all(isinstance(cell, dict) for cell in cells) else []


def _joined(trials: Sequence[Mapping[str, Any]], name: str) -> dict[str, NDArray[Any]]:
    """Fields of all trials, one below the other, and the session of each row."""
    parts = [_fields(trial) for trial in trials]
    if len({tuple(sorted(part)) for part in parts}) > 1:
        raise DataError("trials have different fields", where=f"variable '{name}'", fix="give all trials the same")
    rows = [max((len(array) for array in part.values() if array.ndim), default=0) for part in parts]
    whole = [
        field
        for field in parts[0]
        if all(p[field].ndim and len(p[field]) == n for p, n in zip(parts, rows, strict=True))
    ]
    if set(parts[0]) - set(whole):
        logger.info("of each trial left out, since it has no row per pose: %s", ", ".join(set(parts[0]) - set(whole)))
    joined = {field: np.concatenate([part[field] for part in parts]) for field in whole}
    return {SESSION: np.repeat(np.arange(1, len(parts) + 1), rows)} | joined
