from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.own_files import parts
from softkin.data.readers.file_bundle import write_bundle
from softkin.data.readers.memory_table import Table
from softkin.data.readers.table_formats import open_table


def opened(folder: Path, **entry: Any) -> Table:
    write_bundle(parts(entry), folder / "raw")
    return open_table(folder / "raw", entry)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for trial in (1, 2, 10):
        (tmp_path / f"u_{trial}.csv").write_text(f"t;u1\n0;{trial}\n1;{trial + 0.5}\n")
        (tmp_path / f"x_{trial}.csv").write_text(f"0,{10 * trial}\n1,{10 * trial + 1}\n")
    return tmp_path


def test_trials_of_a_pattern_are_sessions(folder: Path) -> None:
    table = opened(folder, files=["u_*.csv"])
    values, _ = table.read([0, 2], [])
    assert values.T.tolist() == [[1, 1, 2, 2, 3, 3], [1, 1.5, 2, 2.5, 10, 10.5]]


def test_parts_of_each_trial_are_joined_and_each_file_is_read_in_its_own_way(folder: Path) -> None:
    files = ["u_*.csv", {"file": "x_*.csv", "header": "none"}]
    table = opened(folder, files=files, join={"by": "column", "column": ["t", "c1"]})
    assert table.names == ("session", "t", "u1", "c1", "c2")
    values, _ = table.read([0, 2, 4], [])
    assert values[-1].tolist() == [3, 10.5, 101]
    assert table.place(5) == "file u_10.csv, line 3 with file x_10.csv, line 2"
    one = opened(folder, files=["u_1.csv", files[1] | {"file": "x_1.csv"}], join={"by": "row"})  # type: ignore[operator]
    np.testing.assert_array_equal(one.read([1, 3], [])[0], [[1, 10], [1.5, 11]])


def test_a_file_that_cannot_be_read_is_named(folder: Path) -> None:
    with pytest.raises(DataError, match=r"file x_1.csv, line 1: no header"):
        opened(folder, files=["u_1.csv", "x_1.csv"], join={"by": "row"})
    (folder / "u_2.csv").write_text("t;u2\n0;1\n")
    with pytest.raises(DataError, match=r"file u_2.csv: columns differ"):
        opened(folder, files=["u_*.csv"])
