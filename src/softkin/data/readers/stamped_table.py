"""A time that a file holds in two columns, as one: seconds and nanoseconds of ROS, a date and a time of the day."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.data.readers.memory_table import Table

_SECONDS = re.compile(r"(?P<stem>(?:.*[._/ ])?)secs?", re.IGNORECASE)
_NANOSECONDS = "{stem}(n|nano)secs?"
_CLOCK = re.compile(r"\d{1,2}:\d{2}(:\d{2}([.,:]\d+)?)?")
#: What one is called whose columns have no name in common.
STAMP = "stamp"


class StampedTable:
    """A table with one more column, the first: the time that the columns `parts` (two places) tell together."""

    def __init__(self, table: Table, name: str, parts: tuple[int, int], are_text: bool) -> None:
        """`are_text` says that the parts are a date and a time of the day, else seconds and nanoseconds."""
        self._table, self._parts, self._are_text = table, parts, are_text
        self.names: tuple[str, ...] = (name, *table.names)

    @property
    def units(self) -> tuple[str, ...]:
        """Of all columns, or empty."""
        return ("", *self._table.units) if self._table.units else ()

    def read(
        self, numbers: Sequence[int], others: Sequence[int], *, gaps: bool = False
    ) -> tuple[Array, list[NDArray[Any]]]:
        """See `Table`."""
        values, columns = self._table.read(
            [place - 1 for place in numbers if place], [place - 1 for place in others if place], gaps=gaps
        )
        if 0 not in numbers and 0 not in others:
            return values, columns
        stamp = self._stamp()
        rest = iter(columns)
        texts = [next(rest) if place else stamp for place in others]
        if 0 in numbers:
            values = np.insert(values, list(numbers).index(0), stamp.astype(np.float64), axis=1)
        return values, texts

    def look(self) -> list[NDArray[Any]]:
        """See `Table`."""
        looked = self._table.look()
        first, second = (looked[place] for place in self._parts)
        return [self._joined(first, second), *looked]

    def place(self, row: int) -> str:
        """See `Table`."""
        return self._table.place(row)

    def _stamp(self) -> NDArray[Any]:
        if self._are_text:
            _, (date, clock) = self._table.read([], list(self._parts))
            return self._joined(date, clock)
        values, _ = self._table.read(list(self._parts), [], gaps=True)
        return self._joined(values[:, 0], values[:, 1])

    def _joined(self, first: NDArray[Any], second: NDArray[Any]) -> NDArray[Any]:
        if not self._are_text:
            return np.asarray(first + 1e-9 * second, dtype=np.float64)
        joined = np.empty(len(first), dtype=object)
        joined[:] = [f"{date}T{clock}".replace(",", ".") for date, clock in zip(first, second, strict=True)]
        return joined


def stamped(table: Table) -> Table:
    """The table, with its time as one column where two of its columns tell it together; otherwise itself."""
    places = {name: place for place, name in reversed(list(enumerate(table.names)))}
    for name, place in places.items():
        if match := _SECONDS.fullmatch(name):
            stem = match["stem"]
            wanted = re.compile(_NANOSECONDS.format(stem=re.escape(stem)), re.IGNORECASE)
            partner = next((other for other in places if wanted.fullmatch(other)), None)
            called = stem.rstrip("._/ ") or STAMP
            if partner is not None and called not in places:
                return StampedTable(table, called, (place, places[partner]), are_text=False)
    small = {name.lower(): place for name, place in places.items()}
    if "date" in small and "time" in small and "date time" not in places:
        _, columns = table.read([], [small["time"]])
        if len(columns[0]) and _CLOCK.fullmatch(str(columns[0][0]).strip()):
            return StampedTable(table, "date time", (small["date"], small["time"]), are_text=True)
    return table
