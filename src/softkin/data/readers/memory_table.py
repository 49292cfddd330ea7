"""A table in memory: what readers of all kinds of files but text and Parquet make, and columns, splits and the guess
work on.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.data.readers.bad_rows import FIX_MISSING, MISSING, NUMBER, listed

#: Of the cells of a column of numbers that are not empty, this share holds numbers.
MOSTLY = 0.5
#: Of these characters alone, what Python reads as a number is one by `NUMBER`, too.
_OF_NUMBERS = frozenset("0123456789.+-eE")
#: What numpy writes around a number in a list.
_WRAPPED = re.compile(r"np\.\w+\(([^()]*)\)")
_LIST = re.compile(r"\s*[\[(].*[\])]\s*", re.DOTALL)


class Table(Protocol):
    """Columns of a file, by their `names` in its order; `units` of each, where the file tells them, else empty."""

    @property
    def names(self) -> tuple[str, ...]:
        """Of all columns."""
        ...

    @property
    def units(self) -> tuple[str, ...]:
        """Of all columns, or empty."""
        ...

    def read(
        self, numbers: Sequence[int], others: Sequence[int], *, gaps: bool = False
    ) -> tuple[Array, list[NDArray[Any]]]:
        """Columns by their places, each once: `numbers` as (n_rows, n_numbers), each of `others` as text or numbers
        (n_rows,). With `gaps` a missing number is NaN.

        Raises:
            DataError: a value of `numbers` is no finite number.
        """
        ...

    def look(self) -> list[NDArray[Any]]:
        """All columns as far as they can be read: numbers, with NaN where there is none, or text (objects)."""
        ...

    def place(self, row: int) -> str:
        """Where row `row` (from 0) stands in the file."""
        ...


def row_from_0(row: int) -> str:
    """The place of a row in a file whose rows are counted from 0."""
    return f"row {row} (the first is 0)"


@dataclass(frozen=True, slots=True)
class MemoryTable:
    """Columns (n_rows,) of numbers or of objects, and where each row stands."""

    names: tuple[str, ...]
    columns: tuple[NDArray[Any], ...]
    place: Callable[[int], str] = row_from_0
    units: tuple[str, ...] = ()

    def read(
        self, numbers: Sequence[int], others: Sequence[int], *, gaps: bool = False
    ) -> tuple[Array, list[NDArray[Any]]]:
        """See `Table`."""
        n_rows = len(self.columns[0]) if self.columns else 0
        values = np.empty((n_rows, len(numbers)))
        for place, number in enumerate(numbers):
            values[:, place] = self._numbers(number, gaps)
        return values, [self.columns[other] for other in others]

    def look(self) -> list[NDArray[Any]]:
        """See `Table`."""
        return [column if column.dtype != object else looked_at(list(column)) for column in self.columns]

    def _numbers(self, number: int, gaps: bool) -> Array:
        column = self.columns[number]
        if column.dtype != object:
            values = np.asarray(column, dtype=np.float64)
            bad = ~np.isfinite(values) & ~(gaps & np.isnan(values))
        else:
            cells = [number_of(cell) for cell in column]
            bad = np.array([cell is None or not (gaps or np.isfinite(cell)) or np.isinf(cell) for cell in cells])
            values = np.array([np.nan if cell is None else cell for cell in cells])
        if not bad.any():
            return values
        rows = np.flatnonzero(bad)
        cell = column[rows[0]]
        is_missing = is_gap(cell)
        count = f" ({listed('row', rows.tolist())})" if len(rows) > 1 else ""
        raise DataError(
            ("no value" if is_missing else f"no finite number: '{str(cell)[:40]}'") + count,
            where=f"{self.place(int(rows[0]))}, column '{self.names[number]}'",
            fix=FIX_MISSING if is_missing else "correct the value, or leave the column out of the entry",
        )


def is_gap(cell: Any) -> bool:
    """Whether a cell says that there is no value."""
    return (
        cell is None
        or (isinstance(cell, str) and cell.strip() in MISSING)
        or (isinstance(cell, float) and cell != cell)
    )


def number_of(cell: Any) -> float | None:
    """The number in a cell, NaN of an empty one, None of anything else; a truth value is no number."""
    if is_gap(cell):
        return float("nan")
    if isinstance(cell, int | float | np.integer | np.floating) and not isinstance(cell, bool):
        return float(cell)
    if isinstance(cell, str) and NUMBER.fullmatch(cell.strip()):
        return float(cell.strip().replace(",", "."))
    return None


def looked_at(cells: Sequence[Any]) -> NDArray[Any]:
    """Cells of one column as numbers (NaN where there is none) or, where most hold none, as objects."""
    plain = _plain_numbers(cells)
    if plain is not None:
        return plain
    numbers = [number_of(cell) for cell in cells]
    known = sum(number is not None and number == number for number in numbers)
    filled = sum(not is_gap(cell) for cell in cells)
    if filled and known <= MOSTLY * filled:
        texts = np.empty(len(cells), dtype=object)
        texts[:] = [str(cell) for cell in cells]
        return texts
    return np.array([np.nan if number is None else number for number in numbers], dtype=np.float64)


def _plain_numbers(cells: Sequence[Any]) -> Array | None:
    """What `looked_at` makes of texts that are numbers with decimal points, or empty, in a tenth of the time; None
    where a cell is anything else.
    """
    try:
        if not set("".join(cells)) <= _OF_NUMBERS:
            return None
        return np.array([float(cell) if cell else np.nan for cell in cells], dtype=np.float64)
    except (TypeError, ValueError):
        return None


def list_in(cell: Any) -> list[float] | None:
    """The numbers of a list in a cell, written by Python or numpy, or a list itself; None where there is none."""
    if isinstance(cell, list | tuple | np.ndarray):
        parts = list(np.asarray(cell, dtype=object).ravel())
    elif isinstance(cell, str) and _LIST.fullmatch(cell):
        parts = re.sub(r"[\[\](),;]", " ", _WRAPPED.sub(r"\1", cell)).split()
    else:
        return None
    numbers = [number_of(part) for part in parts]
    return (
        None
        if any(number is None for number in numbers) or not numbers
        else [float(n) for n in numbers if n is not None]
    )


def from_cells(
    names: Sequence[str], columns: Sequence[Sequence[Any]], place: Callable[[int], str] = row_from_0
) -> MemoryTable:
    """The table of columns of any cells; a column of lists becomes one column for each of their numbers.

    Raises:
        DataError: lists of one column have different lengths.
    """
    new_names: list[str] = []
    new_columns: list[NDArray[Any]] = []
    for name, cells in zip(names, columns, strict=True):
        lists = [list_in(cell) for cell in cells]
        first = lists[0] if lists else None
        if first is None:
            column = np.empty(len(cells), dtype=object)
            column[:] = list(cells)
            all_numbers = all(isinstance(cell, int | float) and not isinstance(cell, bool) for cell in cells)
            new_names.append(name)
            new_columns.append(column.astype(np.float64) if all_numbers else column)
            continue
        for row, numbers in enumerate(lists):
            if numbers is None or len(numbers) != len(first):
                raise DataError(
                    f"cells hold lists, of {len(first)} numbers in the first row and of "
                    f"{'none' if numbers is None else len(numbers)} here",
                    where=f"{place(row)}, column '{name}'",
                    fix="write lists of equal length, or one number to a cell",
                )
        wide = np.array(lists, dtype=np.float64)
        joint = "_" if name[-1:].isdigit() else ""
        new_names += [f"{name}{joint}{number + 1}" for number in range(wide.shape[1])]
        new_columns += list(wide.T)
    return MemoryTable(tuple(new_names), tuple(new_columns), place)
