from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.parquet_columns import open_parquet, open_table


def test_columns_are_read(tmp_path: Path) -> None:
    pd.DataFrame({"u": [1.0, 2.0], "x": [3, 4]}).to_parquet(tmp_path / "arm")
    table = open_table(tmp_path / "arm", {})
    assert table.names == ("u", "x")
    assert table.read([1], [])[0].tolist() == [[3.0], [4.0]]


@pytest.mark.parametrize("keep", [4, 40, -4])
def test_a_damaged_file_is_an_error(tmp_path: Path, keep: int) -> None:
    path = tmp_path / "arm"
    pd.DataFrame({"x": np.arange(100.0)}).to_parquet(path)
    path.write_bytes(path.read_bytes()[:keep])
    with pytest.raises(DataError, match="not readable as Parquet"):
        open_parquet(path)
