from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.table_formats import open_table


def test_columns_and_gaps_are_read(tmp_path: Path) -> None:
    pd.DataFrame({"u": [1.0, 2.0, 3.0], "x": [3.0, np.nan, 5.0], "trial": list("aab")}).to_feather(tmp_path / "arm")
    table = open_table(tmp_path / "arm", {})
    assert table.names == ("u", "x", "trial")
    values, (trial,) = table.read([0, 1], [2], gaps=True)
    assert values[[0, 2]].tolist() == [[1.0, 3.0], [3.0, 5.0]]
    assert trial.tolist() == ["a", "a", "b"]
    with pytest.raises(DataError, match="row 1"):
        table.read([1], [])


@pytest.mark.parametrize("keep", [8, 100, -8])
def test_a_damaged_file_is_an_error(tmp_path: Path, keep: int) -> None:
    path = tmp_path / "arm"
    pd.DataFrame({"x": np.arange(100.0)}).to_feather(path)
    path.write_bytes(path.read_bytes()[:keep])
    with pytest.raises(DataError, match="not readable as Feather"):
        open_table(path, {})
