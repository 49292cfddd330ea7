from __future__ import annotations

import gzip
import pickle
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.table_formats import TABLE_FORMATS, open_table


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (gzip.compress(b"u1,x"), "unpack it"),
        (b"PK\x03\x04\x14\0\0\0 notes.txt", "a zip file"),
        *((pickle.dumps({"u": [1.0], "x": [2.0]}, protocol), "a pickle, which may run") for protocol in range(6)),
        *((pickle.dumps(np.eye(2), protocol), "a pickle, which may run") for protocol in range(6)),
    ],
)
def test_what_is_no_table_is_named(tmp_path: Path, content: bytes, says: str) -> None:
    (tmp_path / "arm").write_bytes(content)
    with pytest.raises(DataError, match="no table, but") as raised:
        open_table(tmp_path / "arm", {"file": "my arm.pkl"})
    assert says in str(raised.value)


def test_the_two_lines_that_convert_a_pickle_do_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    pd.DataFrame({"u1": [1.0, 2.0], "x": [3.0, 4.0]}).to_pickle("arm.pkl")
    with pytest.raises(DataError) as raised:
        open_table(tmp_path / "arm.pkl", {"file": "arm.pkl"})
    assert raised.value.fix
    first, *lines = raised.value.fix.splitlines()
    assert first.endswith("by two lines of Python:")
    assert len(lines) == 2
    exec("\n".join(line.strip() for line in lines), {})
    assert open_table(tmp_path / "arm.parquet", {}).names == ("u1", "x")


def test_the_first_bytes_decide_and_not_the_name(tmp_path: Path) -> None:
    (tmp_path / "arm.parquet").write_text("u1,x\n1,2\n3,4\n")
    assert open_table(tmp_path / "arm.parquet", {}).names == ("u1", "x")
    assert list(TABLE_FORMATS)[-1] == "text"
