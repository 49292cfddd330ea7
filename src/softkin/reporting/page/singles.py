"""Mark the numbers that hang on a single row, or on a single coordinate."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from softkin.reporting.page.grid import Cell
from softkin.reporting.page.marks import Mark
from softkin.reporting.tables.single_rows import SHARE, Hanging, Number, hanging

#: Of a column of `left_out` that names a row; others name a coordinate.
ROW = "row "
FILE = "tables/left_out.csv has all numbers without it"


class Singles:
    """What numbers hang on."""

    def __init__(self, found: Mapping[Number, Hanging]) -> None:
        self._found = found

    def of(self, number: Number) -> tuple[Mark, ...]:
        """The mark of a number; its words are those of all such numbers of the subset."""
        what = self._found.get(number)
        if what is None:
            return ()
        kind = "one row" if what.left_out.startswith(ROW) else "one coordinate"
        text = (
            f"{number.dataset}, {number.subset}: without {kind} such a number changes by more than {SHARE:.0%}; {FILE}."
        )
        return (Mark(kind, text),)

    def marked(self, cell: Cell, number: Number) -> Cell:
        """The cell of a number, with its mark."""
        return Cell(cell.text, (*cell.marks, *self.of(number)), cell.verdict)


def read_singles(frames: Mapping[str, pd.DataFrame]) -> Singles:
    """Read left_out, where it is."""
    if "left_out" not in frames:
        return Singles({})
    return Singles(hanging(frames["left_out"].fillna({"interval_method": ""})))
