"""A table without the rows in which a number is missing: gaps of a tracker that lost a marker."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.data.readers.memory_table import Table

#: What the number of dropped rows is called in descriptions and data cards.
GAPS = "rows_with_gaps"

logger = logging.getLogger("softkin")


class CompleteRows:
    """A `table` whose rows are dropped where one of the numbers that are read is missing; `n_dropped` counts them."""

    def __init__(self, table: Table) -> None:
        self._table = table
        self._kept: NDArray[np.intp] = np.empty(0, dtype=np.intp)
        self.n_dropped = 0

    @property
    def names(self) -> tuple[str, ...]:
        """Of all columns."""
        return self._table.names

    @property
    def units(self) -> tuple[str, ...]:
        """Of all columns, or empty."""
        return self._table.units

    def read(
        self, numbers: Sequence[int], others: Sequence[int], *, gaps: bool = False
    ) -> tuple[Array, list[NDArray[Any]]]:
        """See `Table`; with `gaps` rows are dropped, too."""
        del gaps
        values, columns = self._table.read(numbers, others, gaps=True)
        is_whole = ~np.isnan(values).any(axis=1)
        self._kept = np.flatnonzero(is_whole)
        self.n_dropped = int((~is_whole).sum())
        if self.n_dropped:
            logger.info("%d of %d rows are dropped, since a number is missing", self.n_dropped, len(values))
        return values[self._kept], [column[self._kept] for column in columns]

    def look(self) -> list[NDArray[Any]]:
        """See `Table`; nothing is dropped."""
        return self._table.look()

    def place(self, row: int) -> str:
        """Where row `row` of those that are kept stands in the file."""
        return self._table.place(int(self._kept[row]))
