from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.nested_values import columns_of
from softkin.data.readers.table_formats import open_table

FRAME = pd.DataFrame({"u": [1.5, 2.0], "x": [3.0, 4.0], "y": [5.0, 6.0]})
RECORDS = FRAME.to_dict("records")
NESTED = [{"u": row["u"], "tip": {"x": row["x"], "y": row["y"]}} for row in RECORDS]
COLUMNS = FRAME.to_dict("list")


@pytest.mark.parametrize("orient", ["records", "split", "table", "index", "columns"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_what_pandas_writes_is_read(tmp_path: Path, orient: Any, encoding: str) -> None:
    (tmp_path / "arm.json").write_text(FRAME.to_json(orient=orient), encoding=encoding)
    table = open_table(tmp_path / "arm.json", {})
    names = [name for name in table.names if name != "index"]
    assert names == ["u", "x", "y"]
    values, _ = table.read([table.names.index(name) for name in names], [])
    np.testing.assert_array_equal(values, FRAME.to_numpy())


@pytest.mark.parametrize(
    ("content", "names"),
    [
        (NESTED, ["u", "tip.x", "tip.y"]),
        ({"robot": {"name": "arm"}, "rate": 50, "data": RECORDS}, ["u", "x", "y"]),
        ({"robot": "arm", "data": COLUMNS}, ["u", "x", "y"]),
        ({"u": COLUMNS["u"], "tip": {"x": COLUMNS["x"], "y": COLUMNS["y"]}}, ["u", "tip.x", "tip.y"]),
        ([[*FRAME], *FRAME.to_numpy().tolist()], ["u", "x", "y"]),
    ],
)
def test_nested_tables_are_found(content: Any, names: list[str]) -> None:
    found = columns_of(content)
    assert list(found) == names
    assert list(found.values()) == list(COLUMNS.values())


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ({"train": RECORDS, "test": RECORDS}, "several tables, under the keys train, test"),
        ([[1.0, 2.0], [3.0, 4.0]], "without names"),
        ([["u", "x"], [1.0]], "1 values for 2 columns"),
        ({"u": 1}, "neither records nor columns"),
        ([1, 2], "neither records nor columns"),
    ],
)
def test_what_is_no_table_is_said(content: Any, says: str) -> None:
    with pytest.raises(DataError, match=says):
        columns_of(content)
