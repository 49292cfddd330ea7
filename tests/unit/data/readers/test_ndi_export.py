from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.table_formats import open_table

EXPORT = (
    "Number of frames: 3\nFrequency: 50\nUnits: mm\n\n"
    "Frame\ttip x\ttip y\ttip z\n1\t1.5\t2\t3\t\n2\t\t\t\t\n3\t4\t5\t-3.697314E28\t\n"
)


@pytest.mark.parametrize("delimiter", ["\t", ","])
def test_names_rate_unit_and_gaps_are_read(tmp_path: Path, delimiter: str) -> None:
    (tmp_path / "take_3d.tsv").write_text(EXPORT.replace("\t", delimiter))
    table = open_table(tmp_path / "take_3d.tsv", {})
    assert table.names == ("Frame", "time", "tip x", "tip y", "tip z")
    assert table.units == ("", "s", "mm", "mm", "mm")
    values, _ = table.read(range(5), [], gaps=True)
    nan = np.nan
    np.testing.assert_array_equal(values, [[1, 0, 1.5, 2, 3], [2, 0.02, nan, nan, nan], [3, 0.04, 4, 5, nan]])
    assert table.place(2) == "line 8"


def test_fewer_frames_than_it_says_and_no_names_are_errors(tmp_path: Path) -> None:
    for text, says in ((EXPORT[:-30], "1 frames, but its first line says 3"), (EXPORT[:40], "without its row of")):
        (tmp_path / "take_3d.tsv").write_text(text)
        with pytest.raises(DataError, match=says):
            open_table(tmp_path / "take_3d.tsv", {})
