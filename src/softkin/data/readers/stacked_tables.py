"""One table of several trials: files of the same columns, one below the other; each is a session."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.data.missing_values import lacks_value
from softkin.data.readers.joined_tables import JoinedTables
from softkin.data.readers.memory_table import Table
from softkin.data.readers.named_arrays import SESSION


class StackedTables:
    """Tables of `trials` (name, table), the rows of one below those of the other. A column `session` numbers the trials
    from 1; where files have a column of that name, it says the trial and what they say.

    Raises:
        DataError: a trial has other columns than the first.
    """

    def __init__(self, trials: Sequence[tuple[str, Table]], unpacked: object = None) -> None:
        """`unpacked` is what keeps the files, as long as the table is there."""
        self._trials, self._unpacked = trials, unpacked
        self._ends: NDArray[np.intp] | None = None
        first, table = trials[0]
        self._own = table.names
        for name, other in trials[1:]:
            if sorted(other.names) != sorted(self._own):
                differing = sorted(set(other.names) ^ set(self._own)) or ["the number of columns of one name"]
                raise DataError(
                    f"columns differ from those of {first}: {', '.join(differing)[:120]}",
                    where=f"file {name}",
                    fix="give all trials the same columns, or write `join` where files are parts of each row",
                )
            if set(zip(other.names, other.units, strict=False)) != set(zip(table.names, table.units, strict=False)):
                raise DataError(
                    f"units differ from those of {first}: {_differing(table, other)}",
                    where=f"file {name}",
                    fix="bring the columns of all trials to the same units",
                )
        self.names: tuple[str, ...] = (SESSION, *(name for name in self._own if name != SESSION))

    @property
    def units(self) -> tuple[str, ...]:
        """Of all columns, as the first trial tells them, or empty."""
        told = dict(zip(self._own, self._trials[0][1].units, strict=False))
        return tuple(told.get(name, "") for name in self.names) if told else ()

    @property
    def unjoined(self) -> NDArray[np.bool_] | None:
        """Rows (n_rows,) that lack a partner, where the trials are joined of parts; None where they are whole files."""
        parts = [table.unjoined for _, table in self._trials if isinstance(table, JoinedTables)]
        return np.concatenate(parts) if parts else None

    def read(
        self, numbers: Sequence[int], others: Sequence[int], *, gaps: bool = False
    ) -> tuple[Array, list[NDArray[Any]]]:
        """See `Table`."""
        wanted = [self.names[place] for place in (*numbers, *others)]
        found = []
        for number, (name, table) in enumerate(self._trials):
            try:
                found.append(self._of_trial(number, table, wanted[: len(numbers)], wanted[len(numbers) :], gaps))
            except DataError as error:
                is_placed = error.where is not None and error.where.startswith("file ")
                raise error if is_placed else error.within(f"file {name}") from error
        self._ends = np.cumsum([len(values) for values, _ in found])
        texts = [_stacked([columns[place] for _, columns in found]) for place in range(len(others))]
        return np.vstack([values for values, _ in found]), texts

    def look(self) -> list[NDArray[Any]]:
        """See `Table`."""
        looked = []
        for number, (_, table) in enumerate(self._trials):
            columns = dict(zip(table.names, table.look(), strict=True))
            n_rows = len(next(iter(columns.values())))
            columns[SESSION] = _session(number, columns.get(SESSION), n_rows)
            looked.append(columns)
        return [_stacked([columns[name] for columns in looked]) for name in self.names]

    def place(self, row: int) -> str:
        """Where row `row` stands, in which file."""
        ends = self._rows_up_to()
        trial = int(np.searchsorted(ends, row, side="right"))
        name, table = self._trials[trial]
        place = table.place(row - (int(ends[trial - 1]) if trial else 0))
        return place if place.startswith("file ") else f"file {name}, {place}"

    def _rows_up_to(self) -> NDArray[np.intp]:
        """How many rows all trials up to each have."""
        if self._ends is None:
            self.read([], [next(place for place, name in enumerate(self.names) if name != SESSION)])
        assert self._ends is not None
        return self._ends

    def _of_trial(
        self, number: int, table: Table, numbers: Sequence[str], others: Sequence[str], gaps: bool
    ) -> tuple[Array, list[NDArray[Any]]]:
        """Columns of one trial by their names, its session among them."""
        place = {name: at for at, name in reversed(list(enumerate(table.names)))}
        own = [name for name in others if name in place]
        known = [name for name in numbers if name in place]
        if not own and not known:
            own = [next(name for name in table.names)]
        values, columns = table.read([place[name] for name in known], [place[name] for name in own], gaps=gaps)
        n_rows = len(values) if known else len(columns[0])
        by_name = dict(zip(own, columns, strict=True)) | dict(zip(known, values.T, strict=True))
        by_name[SESSION] = _session(number, by_name.get(SESSION), n_rows)
        wide = np.empty((n_rows, len(numbers)))
        for at, name in enumerate(numbers):
            wide[:, at] = by_name[name]
        return wide, [by_name[name] for name in others]


def _differing(one: Table, other: Table) -> str:
    """The first column whose unit is another in the other table, with both."""
    first, second = (dict(zip(table.names, table.units, strict=False)) for table in (one, other))
    name = next(name for name in one.names if first.get(name) != second.get(name))
    return f"'{name}' in {first.get(name) or 'none that is told'} there, in {second.get(name) or 'none'} here"


def _session(number: int, own: NDArray[Any] | None, n_rows: int) -> NDArray[Any]:
    """The session of each row of a trial: its number, and what its file says; None where that says nothing."""
    if own is None:
        return np.full(n_rows, float(number + 1))
    labels = np.empty(n_rows, dtype=object)
    labels[:] = [f"{number + 1} {value}" for value in own]
    labels[lacks_value(own)] = None
    return labels


def _stacked(columns: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """Columns of trials, one below the other; as text where one of them is."""
    if any(column.dtype == object for column in columns):
        return np.concatenate([column.astype(object) for column in columns])
    return np.concatenate(columns)
