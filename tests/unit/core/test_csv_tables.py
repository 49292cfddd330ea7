from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.csv_tables import csv_of, read_csv, write_csv

FRAME = pd.DataFrame(
    {
        "method": ["scp", "qr", "cqr"],
        "n_rows": [1, 2, 3],
        "is_in": [True, False, True],
        "width_mm": [1.5, np.inf, np.nan],
        "low_mm": [-np.inf, -2.5e-17, 1e22],
        "ratio": pd.Series([np.inf, None, "refused"], dtype=object),
    }
)


def test_infinite_numbers_are_words_in_the_file_and_numbers_when_read(tmp_path: Path) -> None:
    write_csv(tmp_path / "t.csv", FRAME)
    assert (tmp_path / "t.csv").read_text().splitlines() == [
        "method,n_rows,is_in,width_mm,low_mm,ratio",
        "scp,1,True,1.5,-infinite,infinite",
        "qr,2,False,infinite,-2.5e-17,",
        "cqr,3,True,,1e+22,refused",
    ]
    read = read_csv(tmp_path / "t.csv")
    pd.testing.assert_frame_equal(read.drop(columns="ratio"), FRAME.drop(columns="ratio"))
    assert read["ratio"].tolist()[::2] == ["infinite", "refused"]  # a column of texts stays one
    assert read_csv(tmp_path / "t.csv", dtype={"width_mm": str})["width_mm"][1] == "infinite"
    assert read_csv(tmp_path / "t.csv", dtype=str)["low_mm"][0] == "-infinite"


def test_finite_tables_are_as_pandas_writes_them() -> None:
    numbers = np.random.default_rng(0).standard_normal((200, 2)) * 10.0 ** np.arange(-100, 100)[:, None]
    frame = pd.DataFrame(numbers, columns=["a", "b"]).assign(c="x", d=range(200))
    assert csv_of(frame) == frame.to_csv(index=False)
    one_infinite = csv_of(frame.assign(a=[np.inf, *frame["a"][1:]])).splitlines()
    assert one_infinite[2:] == frame.to_csv(index=False).splitlines()[2:]


def test_an_empty_file_is_as_pandas_says_it(tmp_path: Path) -> None:
    write_csv(tmp_path / "t.csv", pd.DataFrame())
    with pytest.raises(pd.errors.EmptyDataError):
        read_csv(tmp_path / "t.csv")
