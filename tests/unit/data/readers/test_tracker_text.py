from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.tracker_text import frames_table, rows_of_export


def test_empty_cells_and_markers_that_are_not_seen_are_gaps() -> None:
    frames = [["1", "2.5", "a"], ["2", "", "b"], ["3", "-3.697314E+28"]]
    table = frames_table(["Frame", "x", "note", ""], ["", "mm"], frames, 6, 50.0)
    assert table.names == ("Frame", "time", "x", "note")
    assert table.units == ("", "s", "mm", "")
    values, (notes,) = table.read([1, 2], [3], gaps=True)
    np.testing.assert_array_equal(values, [[0.0, 2.5], [0.02, np.nan], [0.04, np.nan]])
    assert notes.tolist() == ["a", "b", ""]
    assert table.place(1) == "line 7"


def test_decimal_commas_are_read_and_words_are_none(tmp_path: Path) -> None:
    table = frames_table(["Frame", "x"], [], [["1", "2,5"], ["2", "lost"]], 2, None)
    with pytest.raises(DataError, match=r"line 3, column 'x': no finite number: 'lost'"):
        table.read([1], [])
    (tmp_path / "take").write_text("Frame\tx\n\n1\t2,5\n")
    assert rows_of_export(tmp_path / "take") == [["Frame", "x"], [], ["1", "2,5"]]
