"""Tables of one's own that cannot be used."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.rotations import KINDS
from softkin.core.samples import command_columns, coordinate_columns
from tests.conftest import bending_arm
from tests.contract.bad_inputs.case import BadInput, prepared
from tests.workbooks import write_workbook

ENTRY: dict[str, Any] = {"format": "table_file", "position_unit": "mm", "split": {"method": "random"}}
ENTRY |= {"commands": command_columns(2), "positions": coordinate_columns(1)}
ROWS = 300


def frame(n_rows: int = ROWS) -> pd.DataFrame:
    rows = bending_arm(n_rows)
    return pd.DataFrame(np.hstack([rows.commands, rows.positions]), columns=[*ENTRY["commands"], *ENTRY["positions"]])


def csv(table: pd.DataFrame) -> str:
    return str(table.round(6).to_csv(index=False))


GOOD = csv(frame())


def text(content: str | bytes, **entry: Any) -> Callable[[], None]:
    return prepared(content, {**ENTRY, **entry})


def workbook(**sheets: Any) -> Callable[[], None]:
    """A workbook of these sheets."""
    return lambda: text(write_workbook(Path("arm.xlsx"), sheets).read_bytes())()


ORIENTED = {"orientation": {"kind": "quaternion_xyzw", "columns": ["o0", "o1", "o2", "o3"]}}


def turned(kind: str, first: float) -> Callable[[], None]:
    """A good table with an orientation whose first column is `first` throughout, and 0 in all others."""
    names = [f"o{place}" for place in range(KINDS[kind])]
    added = dict.fromkeys(names, 0.0) | {"o0": first}
    return of(
        lambda t: [put(name, value)(t) for name, value in added.items()], orientation={"kind": kind, "columns": names}
    )


def cell(value: str) -> Callable[[], None]:
    """A good file with this text in the column m1_z of its 10th line."""
    lines = GOOD.splitlines()
    lines[9] = lines[9].rpartition(",")[0] + f",{value}"
    return text("\n".join(lines))


def of(change: Callable[[pd.DataFrame], object], n_rows: int = ROWS, **entry: Any) -> Callable[[], None]:
    """A good table with one change."""

    def provoke() -> None:
        table = frame(n_rows)
        change(table)
        text(csv(table), **entry)()

    return provoke


def parquet(change: Callable[[pd.DataFrame], object], cut: int | None = None, **entry: Any) -> Callable[[], None]:
    """The same as Parquet, or the first bytes of it."""

    def provoke() -> None:
        table, buffer = frame(), io.BytesIO()
        change(table)
        table.to_parquet(buffer, index=False)
        text(buffer.getvalue()[:cut], **entry)()

    return provoke


def put(column: str, value: Any) -> Callable[[pd.DataFrame], object]:
    return lambda table: table.__setitem__(column, value)


def split(method: str, **options: Any) -> dict[str, Any]:
    return {"split": {"method": method, **options}}


LINE = ("line 10", "column 'm1_z'")
UNCHANGED = put("u1", frame()["u1"])
CASES = [
    BadInput("an empty file", text(""), ("the file is empty",)),
    BadInput("blanks alone", text("\n\n  \n"), ("the file is empty",)),
    BadInput("a header alone", text(GOOD.splitlines()[0]), ("no row of numbers",)),
    BadInput("no header", text(GOOD.partition("\n")[2]), ("no header",)),
    BadInput("one column", text("u1\n1\n2\n"), ("one column only",)),
    BadInput("a zip file", text(b"PK\x03\x04" + b"\0" * 50), ("a zip file",)),
    BadInput("a damaged workbook", text(b"\xd0\xcf\x11\xe0" + b"\0" * 50), ("not readable as a workbook",)),
    BadInput("a file of gzip", text(b"\x1f\x8b" + b"\0" * 50), ("compressed by gzip",)),
    BadInput("an HDF5 file", text(b"\x89HDF" + b"\0" * 50), ("not readable as HDF5",)),
    BadInput("a Feather file cut off", text(b"ARROW1" + b"\0" * 50), ("not readable as Feather",)),
    BadInput("a C3D file cut off", text(b"\x02\x50" + b"\0" * 50), ("C3D",)),
    BadInput("a workbook of two sheets", workbook(a=[["u1"], [1]], b=[["u1"]]), ("2 sheets hold rows", "`sheet`")),
    BadInput("a workbook without rows", workbook(a=[]), ("no sheet holds rows",)),
    BadInput("an export of Vicon without trajectories", text(b"Devices\n1000\n"), ("without trajectories",)),
    BadInput("an export of NDI cut off", text(b"Number of frames: 9\nFrame,x\n1,2\n"), ("first line says 9",)),
    BadInput("a MATLAB file cut off", text(b"MATLAB 5.0 MAT-file" + b"\0" * 50), ("not readable as MATLAB",)),
    BadInput("a pickle", text(b"\x80\x05" + b"\0" * 50), ("a pickle", "read_pickle")),
    BadInput("UTF-16 without its mark", text(GOOD.encode("utf-16-le")), ("zero bytes",)),
    BadInput("a header in Latin-1", text("ü1,b\n1,2\n".encode("latin-1")), ("not utf-8", "line 1")),
    BadInput("a header of one line, no end", text("a,b"), ("no row of numbers",)),
    BadInput("a row cut off", text(GOOD[: GOOD.rindex(",")]), ("values, but the header names 5",)),
    BadInput("a quote left open", text(GOOD.replace("\n", '\n"', 1)), ("arm.csv",)),
    BadInput("an empty cell", cell(""), (*LINE, "no value")),
    BadInput("nan", cell("nan"), (*LINE, "no finite number")),
    BadInput("inf", cell("-inf"), (*LINE, "no finite number")),
    BadInput("1e308", cell("1e308"), (*LINE, "too large a number")),
    BadInput("1e999", cell("1e999"), (*LINE, "too large a number")),
    BadInput("5,000 digits", cell("9" * 5000), (*LINE, "too large a number")),
    BadInput("a word", cell("broken"), (*LINE, "no number: 'broken'")),
    BadInput("a unit behind the number", cell("12 mm"), (*LINE, "no number: '12 mm'")),
    BadInput("an underscore in the number", cell("1_000"), (*LINE, "no number: '1_000'")),
    BadInput("a number in Arabic digits", cell("١٢"), (*LINE, "no number")),
    BadInput("a value too much", cell("1,2"), ("line 10", "6 values")),
    BadInput("a separator of thousands", cell('"1,234.5"'), (*LINE, "separator of thousands")),
    BadInput("no such column", text(GOOD, commands=["u1", "u3"]), ("no column 'u3'", "u1, u2")),
    BadInput("a pattern that matches nothing", text(GOOD, commands="v.*"), ("'v.*' matches no whole name",)),
    BadInput("a column that stands twice", text(GOOD.replace("u2", "u1", 1)), ("2 columns are named 'u1'",)),
    BadInput("axes that change places", of(UNCHANGED, dimensions=2), ("`positions`", "3 columns")),
    BadInput("60 rows", of(UNCHANGED, 60), ("60 rows are too few", "validation gets 4 of at least 5")),
    BadInput("one row", of(UNCHANGED, 1), ("four subsets need at least four",)),
    BadInput("one command alone", of(lambda t: t.update({"u1": [1.0] * ROWS, "u2": [1.0] * ROWS})), ("distinct",)),
    BadInput(
        "commands on one circle",
        of(lambda t: (put("u1", [-1.0, 1.0] * 150)(t), put("u2", [1.0, 1.0] * 150)(t))),
        ("distinct commands",),
    ),
    BadInput("positions that never move", of(lambda t: [put(c, 1.0)(t) for c in ENTRY["positions"]]), ("never move",)),
    BadInput("an empty group", of(put("trial", ["", "a", "b"] * 100), **split("group", column="trial")), ("no value",)),
    BadInput("one group", of(put("trial", "a"), **split("group", column="trial")), ("1 group, but four",)),
    BadInput("a time that is none", of(put("t", "noon"), **split("time", column="t")), ("'noon' is no time",)),
    BadInput("times that stand still", of(put("t", 1.0), **split("time", column="t")), ("1 stretch of time",)),
    BadInput(
        "an unknown subset", of(put("part", "training"), **split("column", column="part")), ("'training' is the",)
    ),
    BadInput("one subset alone", of(put("part", "train"), **split("column", column="part")), ("no row of validation",)),
    BadInput("no such column of a split", text(GOOD, **split("group", column="trial")), ("no column 'trial'",)),
    BadInput("a Parquet file cut off", parquet(UNCHANGED, cut=500), ("not readable as Parquet",)),
    BadInput("Parquet with text for numbers", parquet(put("u1", "a")), ("column 'u1'", "not numbers")),
    BadInput(
        "Parquet with a missing value",
        parquet(lambda t: t.__setitem__("u1", t["u1"].where(t.index != 3))),
        ("row 3", "no value"),
    ),
    BadInput(
        "Parquet with an infinite value",
        parquet(lambda t: t.__setitem__("u1", t["u1"].where(t.index != 3, np.inf))),
        ("row 3", "no finite"),
    ),
    BadInput("Parquet with whole numbers beyond floats", parquet(put("u1", 2**60 + 1)), ("column 'u1'", "cannot hold")),
    BadInput("Parquet with lists", parquet(put("u1", [[1.0]] * ROWS)), ("no column 'u1'", "u1_1")),
    BadInput("Parquet without the column", parquet(lambda t: t.pop("u2")), ("no column 'u2'",)),
    BadInput(
        "a quaternion that is not of unit norm", turned("quaternion_wxyz", 0.5), ("columns o0, o1, o2, o3", "norm is")
    ),
    BadInput("a matrix that is no rotation", turned("rotation_matrix", 0.5), ("line 2, columns o0", "not orthonormal")),
    BadInput("an orientation with a gap", turned("roll_pitch_yaw_degrees", np.nan), ("column 'o0'", "no value")),
    BadInput("no such column of an orientation", text(GOOD, **ORIENTED), ("no column 'o0'", "`orientation.columns`")),
]
