from __future__ import annotations

from softkin.data.readers.complete_rows import CompleteRows
from softkin.data.readers.memory_table import from_cells


def test_rows_with_gaps_are_dropped_and_counted_and_places_stay() -> None:
    table = CompleteRows(from_cells(["u", "x", "note"], [[1, 2, 3, 4], [1.0, None, "", 7], ["a", "b", "c", "d"]]))
    values, (notes,) = table.read([0, 1], [2])
    assert values.tolist() == [[1, 1], [4, 7]]
    assert notes.tolist() == ["a", "d"]
    assert table.n_dropped == 2
    assert table.place(1) == "row 3 (the first is 0)"
    assert (table.names, table.units, len(table.look())) == (("u", "x", "note"), (), 3)
