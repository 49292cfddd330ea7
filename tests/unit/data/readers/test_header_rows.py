from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.delimited_text import open_table
from softkin.data.readers.header_rows import are_units, has_more_names, joined_names

ROWS = "1.5,2,3.5,4,5\n6,7.5,8,9,10.5\n11,12,13,14,15\n"
NAMES = ("u1", "u2", "x", "y", "z")
VALUES = np.array([[1.5, 2, 3.5, 4, 5], [6, 7.5, 8, 9, 10.5], [11, 12, 13, 14, 15]])


@pytest.mark.parametrize(
    ("above", "names"),
    [
        ("cmd,cmd,tip,tip,tip\nu1,u2,x,y,z\n", NAMES),
        ("cmd,,tip,,\nu1,u2,x,y,z\n", NAMES),
        ("cmd,,tip,,\n1,2,x,y,z\n", ("cmd 1", "cmd 2", "tip x", "tip y", "tip z")),
        ("cmd,cmd,tip,tip,base\nu,v,x,y,x\n", ("cmd u", "cmd v", "tip x", "tip y", "base x")),
        ("cmd,,tip,,\nu1,u2,x,y,z\nbar,bar,mm,mm,mm\n", NAMES),
        ("// log\n// u1 u2 x y z\n", NAMES),
        ('"u1", "u2", "x", "y", "z"\n', NAMES),
        ("u1,u2,x,y,z\n(kPa),(kPa),millimeters,millimeters,millimeters\n", NAMES),
    ],
)
def test_names_above_the_rows_are_found(tmp_path: Path, above: str, names: tuple[str, ...]) -> None:
    (tmp_path / "arm.csv").write_text(above + ROWS)
    table = open_table(tmp_path / "arm.csv", {})
    assert table.names == names
    np.testing.assert_array_equal(table.read(range(5), [])[0], VALUES)


def test_a_delimiter_at_the_end_of_each_row_is_no_column(tmp_path: Path) -> None:
    (tmp_path / "arm.csv").write_text("u1,u2,x,y,z\n" + ROWS.replace("\n", ",\n"))
    table = open_table(tmp_path / "arm.csv", {})
    assert table.names == (*NAMES, "")
    np.testing.assert_array_equal(table.read(range(5), [])[0], VALUES)


@pytest.mark.parametrize("first", ["1.5,2,3.5,4,world\n", "2024-05-31,2.5,3.5,4,5\n"])
def test_a_row_of_numbers_and_text_is_no_header(tmp_path: Path, first: str) -> None:
    (tmp_path / "arm.csv").write_text(first + ROWS)
    with pytest.raises(DataError, match="no header: the first row holds numbers"):
        open_table(tmp_path / "arm.csv", {})
    (tmp_path / "arm.csv").write_text("%time,u1,x,y,frame\n" + first + ROWS)
    assert open_table(tmp_path / "arm.csv", {}).names == ("time", "u1", "x", "y", "frame")


def test_a_row_of_data_is_no_second_row_of_names() -> None:
    values = [["1.5", "2", "3"]]
    assert has_more_names([["cmd", "tip", "tip"], ["u", "x", "y"], *values])
    for names, below in (
        (["u", "x", "y"], ["left", "mm", "mm"]),
        (["cmd", "tip", "tip"], ["NA", "NA", "NA"]),
        (["cmd", "tip", "tip"], ["0.1", "on", "on"]),
        (["cmd", "tip", "tip"], ["bar", "mm", "mm"]),
    ):
        assert not has_more_names([names, below, *values])


def test_groups_are_named_where_names_repeat() -> None:
    assert joined_names(["", "tip", "", "base", ""], ["u", "x", "y", "x", "y"]) == (
        "u",
        "tip x",
        "tip y",
        "base x",
        "base y",
    )
    assert joined_names(["log of May"], ["u", "x"]) == ("u", "x")


def test_units_are_known() -> None:
    assert are_units(["[m]", "(kPa)", "ul/min", "degrees", "", "a.u."])
    assert not are_units(["mm", "left"])
