from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from softkin.cli.differences import differ, differences, other_line
from softkin.core.csv_tables import write_csv

FRAME = pd.DataFrame({"model": ["lr", "gp"], "rmse_mm": [1.0, np.inf], "n": [1, 2], "note": [None, "x"]})


def test_the_first_cell_that_differs_is_named(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    write_csv(path, FRAME)
    assert differences(path, FRAME) == []
    assert differences(path, FRAME.assign(rmse_mm=[1.0 + 1e-11, np.inf])) == []
    (close,) = differences(path, FRAME.assign(rmse_mm=[1.0 + 1e-11, np.inf]), 1e-12)
    assert "row 1, column rmse_mm: 1.0 stands there, and its sources give 1.00000000001" in close
    (endless,) = differences(path, FRAME.assign(rmse_mm=[1.0, 2.0]))
    assert "row 2, column rmse_mm: inf stands there" in endless
    (word,) = differences(path, FRAME.assign(model=["lr", "mlp"]))
    assert "row 2, column model: gp stands there, and its sources give mlp" in word


def test_rows_and_columns_that_are_not_the_same_are_named(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    write_csv(path, FRAME)
    assert "has 2 rows, and its sources give 1" in differences(path, FRAME.head(1))[0]
    assert "has no column m" in differences(path, FRAME.assign(m=1))[0]
    assert differences(path, FRAME.drop(columns="n")) == []
    (more,) = differences(path, FRAME.drop(columns="n"), all_columns=True)
    assert "has a column n, which its sources do not give" in more


def test_missing_numbers_are_the_same_and_no_zeros() -> None:
    old, new = pd.Series([np.nan, np.nan, 0.0]), pd.Series([np.nan, 0.0, 1e-300])
    assert differ(old, new).tolist() == [False, True, True]


def test_the_line_of_a_text_that_differs_is_named(tmp_path: Path) -> None:
    old, new = tmp_path / "old.md", tmp_path / "new.md"
    old.write_text("a\nb\n")
    new.write_text("a\nc\nd\n")
    assert other_line(old, new) == f"{old}, line 2: 'b' stands there, and its sources give 'c'"
    new.write_text("a\nb")
    assert other_line(old, new) == f"{old} ends otherwise than its sources give"
    new.write_bytes(b"\xff\x00")
    assert other_line(old, new) == f"{old} is not what its sources give"


def test_long_texts_are_shown_where_they_part(tmp_path: Path) -> None:
    path, made = tmp_path / "t.csv", tmp_path / "made.md"
    same = "the same words " * 20
    write_csv(path, FRAME.assign(note=[None, f"{same}old{same}"]))
    (found,) = differences(path, FRAME.assign(note=[None, f"{same}new{same}"]))
    assert "words old" in found
    assert "words new" in found
    assert len(found) < len(str(path)) + 300
    path.write_text(f"{same}old")
    made.write_text(f"{same}new and more")
    expected = f"'...{same[-30:]}old' stands there, and its sources give '...{same[-30:]}new and more'"
    assert other_line(path, made) == f"{path}, line 1: {expected}"
