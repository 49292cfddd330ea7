"""What people hand to a calibrated model, checked: rows, columns by name, confidence levels."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass
from numbers import Real
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.errors import ConfigError, DataError
from softkin.core.samples import MAX_MAGNITUDE, Array, command_columns, coordinate_columns
from softkin.core.units import MM, unit_of

#: A table, array, list or one row.
Rows = Any
#: Kinds of arrays that hold no real numbers.
KINDS = {"b": "truth values", "c": "complex numbers", "U": "text", "S": "text", "M": "dates", "m": "times"}


@dataclass(frozen=True, slots=True)
class Names:
    """What the columns of a robot are called: in its own file, where that is known, and in softkin's tables.

    `scale` takes its own positions to `unit`, that of answers; `dimensions` 2: its markers are planar, z is 0.
    """

    n_commands: int
    n_coordinates: int
    own_commands: Sequence[str] = ()
    own_positions: Sequence[str] = ()
    scale: float = 1.0
    dimensions: int = 3
    unit: str = MM

    @classmethod
    def of(cls, n_commands: int, n_coordinates: int, about: Mapping[str, Any]) -> Names:
        """From what is known of a robot: `columns`, where its own names are, and `unit`, where it is not mm."""
        columns = about.get("columns", {"commands": (), "positions": (), "mm_per_unit": 1.0, "dimensions": 3})
        own = columns["commands"], columns["positions"], columns["mm_per_unit"], columns["dimensions"]
        return cls(n_commands, n_coordinates, *own, unit_of(about))

    @property
    def coordinates(self) -> list[str]:
        """m1_x, m1_y, ..."""
        return coordinate_columns(self.n_coordinates // 3)

    def commands_in(self, frame: pd.DataFrame, where: str) -> pd.DataFrame:
        """The columns of commands in the robot's order, by its own names or u1, u2, ...

        Raises:
            DataError: names the columns that are missing, unknown, or there twice.
        """
        return _chosen(frame, [self.own_commands, command_columns(self.n_commands)], "commands", where)

    def positions_in(self, frame: pd.DataFrame, where: str) -> pd.DataFrame:
        """The columns of positions in mm, in the robot's order, by its own names (in its own unit) or m1_x, m1_y, ...

        Raises:
            DataError: names the columns that are missing, unknown, or there twice.
        """
        chosen = _chosen(frame, [self.own_positions, self.coordinates], "positions", where)
        if list(chosen.columns) != list(self.own_positions):
            return chosen
        values = numbers(chosen, "positions", where) * self.scale
        markers = values.reshape(len(values), -1, self.dimensions)
        spatial = np.pad(markers, ((0, 0), (0, 0), (0, 3 - self.dimensions))).reshape(len(values), -1)
        return pd.DataFrame(spatial, index=frame.index, columns=self.coordinates)


def command_rows(commands: Rows, names: Names, n_inputs: int, where: str) -> Array:
    """Finite commands (n_rows, n_commands), or inputs (n_rows, n_inputs) of a recording, from whatever holds them.

    Raises:
        DataError: another shape, no numbers, not finite, other columns than the robot's.
    """
    if isinstance(commands, pd.Series):
        commands = commands.to_frame().T.infer_objects()
    if isinstance(commands, pd.DataFrame):
        commands = names.commands_in(commands, where)
    labels = command_columns(names.n_commands)
    rows = numbers(commands, "commands", where)
    rows = rows.reshape(1, -1) if rows.ndim < 2 else rows
    if rows.ndim != 2 or rows.shape[1] not in (names.n_commands, n_inputs) or not len(rows):
        raise DataError(
            f"expected finite commands of shape (n_rows, {names.n_commands}), got {np.shape(commands)}",
            where=where,
            fix=f"pass one row of {names.n_commands} finite numbers per pose",
        )
    check_finite(rows, commands, labels, where)
    return rows


def position_rows(positions: Rows, names: Names, n_rows: int, where: str) -> Array:
    """Finite positions (n_rows, n_coordinates) in mm, one row for each command.

    Raises:
        DataError: as for commands, or another number of rows.
    """
    if isinstance(positions, pd.Series):
        positions = positions.to_frame().T.infer_objects()
    if isinstance(positions, pd.DataFrame):
        positions = names.positions_in(positions, where)
    rows = numbers(positions, "positions", where)
    rows = rows.reshape(1, -1) if rows.ndim < 2 else rows
    if rows.shape != (n_rows, names.n_coordinates):
        raise DataError(
            f"expected positions of shape ({n_rows}, {names.n_coordinates}), got {np.shape(positions)}",
            where=where,
            fix=f"pass {names.n_coordinates} coordinates in {names.unit} for each of the {n_rows} commands",
        )
    check_finite(rows, positions, names.coordinates, where)
    return rows


def check_same_rows(commands: Rows, positions: Rows, where: str) -> None:
    """Two tables are of the same rows.

    Raises:
        DataError: their indices differ: one was sorted, or cut, and the other was not.
    """
    tables = isinstance(commands, pd.DataFrame) and isinstance(positions, pd.DataFrame)
    if tables and len(commands) == len(positions) and not commands.index.equals(positions.index):
        raise DataError(
            "the tables of commands and of positions have other indices",
            where=where,
            fix="take both from one table, or reset_index(drop=True) where their rows belong together",
        )


def levels_of(confidence_levels: Any, where: str) -> tuple[list[float], bool]:
    """(confidence levels in the order given, whether it was one number).

    Raises:
        ConfigError: no number, none, not between 0 and 1, or in what has no order.
    """
    is_one = not isinstance(confidence_levels, Iterable) or isinstance(confidence_levels, (str, bytes))
    is_one = is_one or (isinstance(confidence_levels, np.ndarray) and confidence_levels.ndim == 0)
    if isinstance(confidence_levels, (Mapping, Set)):
        kind = type(confidence_levels).__name__
        raise ConfigError(
            f"confidence levels in a {kind}", where=where, fix="pass one such as 0.9, or a list of several"
        )
    given = [confidence_levels] if is_one else list(confidence_levels)
    if not given:
        raise ConfigError("no confidence level", where=where, fix="pass one such as 0.9, or several")
    return [level_of(level, where) for level in given], is_one


def level_of(level: Any, where: str, what: str = "confidence level") -> float:
    """One number in (0, 1); of a short float the decimals that it is written with.

    Raises:
        ConfigError: it is none.
    """
    value = level.item() if isinstance(level, np.ndarray) and level.ndim == 0 else level
    is_number = isinstance(value, Real) and not isinstance(value, (bool, np.bool_))
    number = float(str(value)) if is_number and isinstance(value, np.floating) else float(value) if is_number else 0.0
    if not 0 < number < 1:
        share = f"{number / 100:g}" if 1 < number < 100 else "0.9"
        raise ConfigError(f"{value!r} is no {what} between 0 and 1", where=where, fix=f"write it as {share}")
    return number


def numbers(values: Rows, what: str, where: str) -> Array:
    """Values as 64-bit floats, without taking text, truth values or complex numbers for numbers.

    Raises:
        DataError: they are none; names the column of a table.
    """
    if isinstance(values, np.ndarray) and values.dtype == np.float64 and type(values) is np.ndarray:
        return values
    fix = f"pass {what} as numbers, in an array, a list or a DataFrame"
    if isinstance(values, pd.DataFrame):
        for place, name in enumerate(values.columns):
            column = values.iloc[:, place]
            is_number = pd.api.types.is_any_real_numeric_dtype(column.dtype)
            if not is_number or pd.api.types.is_bool_dtype(column.dtype):
                raise DataError(f"column '{name}' of {what} holds no numbers", where=where, fix=fix)
        return np.asarray(values.to_numpy(dtype=np.float64, na_value=np.nan))
    if np.ma.isMaskedArray(values):
        raise DataError(f"{what} are masked", where=where, fix="leave the masked rows out")
    try:
        array = np.asarray(values)
    except ValueError:
        raise DataError(f"rows of {what} have different lengths", where=where, fix=fix) from None
    if array.dtype == object:
        array = _numbers_among(array, what, where, fix)
    if array.dtype.kind not in "iuf":
        raise DataError(f"{what} are {KINDS.get(array.dtype.kind, 'no numbers')}", where=where, fix=fix)
    return array.astype(np.float64)


def _numbers_among(array: Any, what: str, where: str, fix: str) -> Array:
    for value in array.flat:
        if value is not None and (not isinstance(value, Real) or isinstance(value, (bool, np.bool_))):
            raise DataError(f"{what} hold {type(value).__name__} {str(value)[:40]!r}", where=where, fix=fix)
    return np.array([math.nan if value is None else float(value) for value in array.flat]).reshape(array.shape)


def check_finite(rows: Array, given: Rows, labels: Sequence[str], where: str) -> None:
    """Finite, and not so large that arithmetic overflows; says which row and which column."""
    # The sum of a few numbers is faster than a comparison of each; it is no number where one of them is none.
    if np.abs(rows).sum() <= MAX_MAGNITUDE:
        return
    wrong = ~(np.abs(rows) <= MAX_MAGNITUDE)
    if not wrong.any():
        return
    row, column = (int(place) for place in np.argwhere(wrong)[0])
    is_table = isinstance(given, pd.DataFrame)
    label = given.index[row] if is_table else row
    name = given.columns[column] if is_table else labels[column] if column < len(labels) else column
    more = f", and {wrong.sum() - 1} more" if wrong.sum() > 1 else ""
    raise DataError(
        f"row {label}, column '{name}': {rows[row, column]:g} is no finite number of at most 1e100{more}",
        where=where,
        fix="leave such rows out; a value that is not known cannot be predicted from",
    )


def _chosen(frame: pd.DataFrame, namings: Iterable[Sequence[str]], what: str, where: str) -> pd.DataFrame:
    """The columns by one of several namings, in its order."""
    given = [str(name).strip() for name in frame.columns]
    wanted = [list(map(str, naming)) for naming in namings if len(naming)]
    nearest = max(wanted, key=lambda naming: len(set(naming) & set(given)))
    twice = [name for name, count in Counter(given).items() if count > 1]
    missing = [name for name in nearest if name not in given]
    unknown = [name for name in given if name not in nearest]
    problems = [
        f"{text} {', '.join(map(repr, names[:8]))}{' ...' if len(names) > 8 else ''}"
        for text, names in (("twice", twice), ("missing", missing), ("unknown", unknown))
        if names
    ]
    if problems:
        raise DataError(
            f"columns of {what}: {'; '.join(problems)}",
            where=where,
            fix=f"pass the columns {', '.join(nearest[:8])}{' ...' if len(nearest) > 8 else ''} and no others",
        )
    return frame.iloc[:, [given.index(name) for name in nearest]].set_axis(nearest, axis=1)
