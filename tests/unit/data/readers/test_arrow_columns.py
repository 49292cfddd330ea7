from __future__ import annotations

import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from softkin.core.errors import DataError
from softkin.data.readers.parquet_columns import open_parquet


def write(folder: Path, **columns: Any) -> Path:
    path = folder / "robot.parquet"
    pq.write_table(pa.table(columns), path)
    return path


@given(arrays(float, (4, 2), elements=st.floats(allow_nan=False, allow_infinity=False)))
def test_every_float_survives_to_the_bit(tmp_path_factory: pytest.TempPathFactory, values: Any) -> None:
    path = write(tmp_path_factory.mktemp("parquet"), u=values[:, 0], x=values[:, 1])
    table = open_parquet(path)
    assert table.names == ("u", "x")
    assert table.read([0, 1], [])[0].tobytes() == np.ascontiguousarray(values).tobytes()
    assert table.read([1, 0], [])[0].tobytes() == np.ascontiguousarray(values[:, ::-1]).tobytes()


def test_other_kinds_of_numbers_and_other_columns_are_read(tmp_path: Path) -> None:
    days = [datetime.datetime(2024, 5, day) for day in (3, 1)]
    path = write(
        tmp_path,
        whole=pa.array([1, -2]),
        trial=pa.array([7, 8]),
        short=pa.array([0.5, 0.25], pa.float32()),
        decimal=pa.array(["1.5", "2.5"]).cast(pa.decimal128(4, 2)),
        text=["a", "b"],
        category=pa.array(["p", "q"]).dictionary_encode(),
        when=days,
    )
    values, (trial, text, category, when) = open_parquet(path).read([0, 2, 3], [1, 4, 5, 6])
    assert values.tolist() == [[1.0, 0.5, 1.5], [-2.0, 0.25, 2.5]]
    assert (trial.tolist(), text.tolist(), category.tolist()) == ([7, 8], ["a", "b"], ["p", "q"])
    assert when[0] > when[1]


@pytest.mark.parametrize(
    ("column", "says"),
    [
        (
            [1.0, float("nan"), float("nan")],
            ["row 1 (the first is 0), column 'x': no finite number (rows with such problems: 2, rows 1, 2)"],
        ),
        ([1.0, 2.0, float("inf")], ["row 2 (the first is 0), column 'x': no finite number"]),
        ([None, 1.0, 2.0], ["row 0 (the first is 0), column 'x': no value"]),
        (["1", "2", "3"], ["column 'x': values of type string, not numbers", "store the column as numbers"]),
        ([True, False, True], ["column 'x': values of type bool, not numbers"]),
        ([b"1", b"2", b"3"], ["column 'x': values of type binary"]),
        ([1, 2**53 + 1, 3], ["column 'x'", "9007199254740993", "rescale"]),
    ],
)
def test_a_bad_column_is_an_error(tmp_path: Path, column: list[Any], says: list[str]) -> None:
    with pytest.raises(DataError) as error:
        open_parquet(write(tmp_path, x=column)).read([0], [])
    for part in ("\n  fix: ", *says):
        assert part in str(error.value)


@pytest.mark.parametrize("column", [[None, "a"], [float("nan"), 1.0], [b"\xff", b"a"]])
def test_a_column_that_cannot_split_is_an_error(tmp_path: Path, column: list[Any]) -> None:
    with pytest.raises(DataError, match="column 'x'"):
        open_parquet(write(tmp_path, x=column)).read([], [0])


def test_lists_and_records_become_columns(tmp_path: Path) -> None:
    table = open_parquet(write(tmp_path, u=[[1.0, 2.0], [3.0, 4.0]], tip=[{"x": 5.0, "y": 6}, {"x": 7.0, "y": 8}]))
    assert table.names == ("u1", "u2", "tip.x", "tip.y")
    assert table.read(range(4), [])[0].tolist() == [[1, 2, 5, 6], [3, 4, 7, 8]]
    with pytest.raises(DataError, match="cells hold lists"):
        open_parquet(write(tmp_path, u=[[1.0, 2.0], [3.0]]))
