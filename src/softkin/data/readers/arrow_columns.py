"""Columns of a file that pyarrow reads: Parquet, Feather."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.data.readers.bad_rows import FIX_MISSING, listed
from softkin.data.readers.memory_table import Table, from_cells, row_from_0
from softkin.data.readers.nested_values import columns_of


@dataclass(frozen=True, slots=True)
class ArrowColumns:
    """The `names` of the columns of a file in their order, and `load`, which reads columns by their names as a table of
    pyarrow. `kind` names the format in messages.
    """

    names: tuple[str, ...]
    load: Callable[[list[str]], Any]
    kind: str

    @property
    def units(self) -> tuple[str, ...]:
        """None are told."""
        return ()

    def read(
        self, numbers: Sequence[int], others: Sequence[int], *, gaps: bool = False
    ) -> tuple[Array, list[NDArray[Any]]]:
        """Columns by their places, each once: `numbers` as (n_rows, n_numbers), each of `others` as text or, where the
        file holds numbers or times, as numbers (n_rows,). With `gaps` a missing number is NaN.

        Raises:
            DataError: a value of `numbers` is no finite number, or a column holds something else.
        """
        table = self._loaded([self.names[place] for place in (*numbers, *others)])
        values = np.empty((table.num_rows, len(numbers)))
        for place, number in enumerate(numbers):
            values[:, place] = self._numbers(table, self.names[number], gaps)
        return values, [self._other(table, self.names[other]) for other in others]

    def look(self) -> list[NDArray[Any]]:
        """All columns as far as they can be read: numbers, with NaN where there is none, or text."""
        return [_looked_at(column) for column in self._loaded(list(self.names)).columns]

    def place(self, row: int) -> str:
        """Where row `row` stands in the file."""
        return row_from_0(row)

    def _loaded(self, names: list[str]) -> Any:
        import pyarrow as pa

        try:
            return self.load(names)
        except (pa.ArrowException, OSError) as error:
            raise unreadable(self.kind, error) from error

    def _numbers(self, table: Any, name: str, gaps: bool) -> Array:
        import pyarrow as pa

        column = table.column(name)
        kind = column.type
        if not (pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_decimal(kind)):
            raise DataError(
                f"values of type {kind}, not numbers",
                where=f"column '{name}'",
                fix="store the column as numbers, or leave it out of the entry",
            )
        if not gaps:
            self._refuse(name, np.asarray(column.is_null()), "no value")
        try:
            numbers = np.asarray(column.cast(pa.float64()).to_numpy(), dtype=np.float64)
        except pa.ArrowInvalid as error:
            raise DataError(
                f"64-bit floats cannot hold these whole numbers: {error}",
                where=f"column '{name}'",
                fix="rescale the column",
            ) from error
        self._refuse(name, ~np.isfinite(numbers) & ~(gaps & np.isnan(numbers)), "no finite number")
        return numbers

    def _other(self, table: Any, name: str) -> NDArray[Any]:
        import pyarrow as pa

        column = table.column(name)
        kind = column.type
        self._refuse(name, np.asarray(column.is_null()), "no value")
        if pa.types.is_timestamp(kind) or pa.types.is_duration(kind):
            return np.asarray(column.cast(pa.int64()).to_numpy())
        if pa.types.is_integer(kind) or pa.types.is_floating(kind):
            numbers = np.asarray(column.to_numpy())
            self._refuse(name, ~np.isfinite(numbers), "no finite number")
            return numbers
        try:
            return np.asarray(column.cast(pa.string()).to_numpy()).astype(object)
        except pa.ArrowException as error:
            raise DataError(
                f"rows cannot be split by {kind}", where=f"column '{name}'", fix="store it as text or numbers"
            ) from error

    def _refuse(self, name: str, bad: NDArray[np.bool_], what: str) -> None:
        if bad.any():
            raise DataError(
                what if bad.sum() == 1 else f"{what} ({listed('row', np.flatnonzero(bad).tolist())})",
                where=f"{self.place(int(np.argmax(bad)))}, column '{name}'",
                fix=FIX_MISSING,
            )


def spread(columns: ArrowColumns, schema: Any) -> Table:
    """The same columns; where values of some, by the `schema` of pyarrow, are lists or records, a column for each of
    their parts.

    Raises:
        DataError: lists of one column have different lengths, or the file is damaged.
    """
    import pyarrow as pa

    if not any(pa.types.is_nested(field.type) for field in schema):
        return columns
    try:
        records = columns.load(list(columns.names)).to_pylist()
    except (pa.ArrowException, OSError) as error:
        raise unreadable(columns.kind, error) from error
    found = columns_of(records)
    return from_cells(list(found), list(found.values()))


def unreadable(kind: str, error: Exception) -> DataError:
    """That a file of this kind is damaged, and why."""
    return DataError(f"not readable as {kind}: {error}", fix="write the file anew")


def _looked_at(column: Any) -> NDArray[Any]:
    import pyarrow as pa

    kind = column.type
    if pa.types.is_integer(kind) or pa.types.is_floating(kind):
        return np.asarray(column.to_numpy(), dtype=np.float64)
    if pa.types.is_timestamp(kind) or pa.types.is_duration(kind):
        return np.asarray(column.cast(pa.int64()).to_numpy(), dtype=np.float64)
    return np.array([str(cell) for cell in column.to_pylist()], dtype=object)
