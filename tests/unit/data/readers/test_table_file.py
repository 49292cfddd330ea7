from __future__ import annotations

import contextlib
import logging
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from softkin.core.errors import DataError
from softkin.core.samples import SUBSETS, Samples
from softkin.data.readers.table_file import read
from tests.conftest import HOUSE, bending_arm

EXAMPLE = HOUSE / "config" / "examples" / "bending_arm.csv"


def frame(n_rows: int = 300, **arm: int) -> pd.DataFrame:
    rows = bending_arm(n_rows, **arm)
    names = [f"u{place + 1}" for place in range(rows.commands.shape[1])]
    names += [f"m{place // 3 + 1}_{'xyz'[place % 3]}" for place in range(rows.positions.shape[1])]
    return pd.DataFrame(np.hstack([rows.commands, rows.positions]), columns=names)


def parse(folder: Path, table: pd.DataFrame | str | bytes, suffix: str = "csv", **changes: Any) -> dict[str, Samples]:
    path = folder / f"robot.{suffix}"
    if isinstance(table, pd.DataFrame):
        {"csv": table.to_csv, "parquet": table.to_parquet}[suffix](path, index=False)
    else:
        path.write_bytes(table if isinstance(table, bytes) else table.encode())
    entry = {"file": "arm.csv", "position_unit": "mm", "commands": "u[0-9]+", "positions": "m[0-9]+_[xyz]"}
    return read(path, dataset="arm", source=entry | {"split": {"method": "random"}} | changes)


def all_rows(subsets: dict[str, Samples]) -> Any:
    """Commands and positions of all subsets, sorted."""
    rows = np.vstack([np.hstack([rows.commands, rows.positions]) for rows in subsets.values()])
    return rows[np.lexsort(rows.T)]


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
@pytest.mark.parametrize(("n_commands", "n_markers"), [(1, 1), (2, 3), (64, 2)])
def test_one_marker_or_many_of_one_command_or_many(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, suffix: str, n_commands: int, n_markers: int
) -> None:
    table = frame(n_commands=n_commands, n_markers=n_markers)
    subsets = parse(tmp_path, table, suffix, n_commands=n_commands, n_markers=n_markers)
    assert tuple(subsets) == SUBSETS
    for rows in subsets.values():
        assert rows.commands.shape[1] == n_commands
        assert rows.positions.shape[1] == 3 * n_markers
    whole = table.to_numpy()
    np.testing.assert_array_equal(all_rows(subsets), whole[np.lexsort(whole.T)])
    assert not [record for record in caplog.records if record.levelno > logging.INFO]


def test_rows_keep_the_order_of_the_file(tmp_path: Path) -> None:
    table = frame(100)
    table["m1_z"] = np.arange(100.0)
    for rows in parse(tmp_path, table).values():
        assert (np.diff(rows.positions[:, 2]) > 0).all()


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_a_planar_robot_gets_a_third_coordinate_of_zero(tmp_path: Path, suffix: str) -> None:
    table = frame(200, n_markers=3).drop(columns=["m1_z", "m2_z", "m3_z"])
    subsets = parse(tmp_path, table, suffix, dimensions=2, n_markers=3)
    for rows in subsets.values():
        assert rows.positions.shape[1] == 9
        assert (rows.positions[:, 2::3] == 0).all()
    rows = all_rows(subsets)[:, [0, 1, 2, 3, 5, 6, 8, 9]]
    whole = table.to_numpy()
    np.testing.assert_array_equal(rows[np.lexsort(rows.T)], whole[np.lexsort(whole.T)])


def test_the_files_own_subsets_are_kept(tmp_path: Path) -> None:
    table = frame(200)
    table.insert(0, "part", np.repeat(["train", "val", "test", "ext"], [120, 30, 20, 30]))
    subsets = parse(tmp_path, table, split={"method": "column", "column": "part"})
    assert {subset: len(rows) for subset, rows in subsets.items()} == dict(zip(SUBSETS, [120, 30, 20, 30], strict=True))
    np.testing.assert_array_equal(subsets["test"].commands, table.loc[150:169, ["u1", "u2"]])


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
@pytest.mark.parametrize("column", ["trial", "u1"])
def test_groups_stay_together_also_those_of_a_command(tmp_path: Path, suffix: str, column: str) -> None:
    table = frame(600)
    table["u1"] = table["u1"].round(1)
    table["trial"] = np.arange(600) // 10
    table["m1_z"] = table[column]
    subsets = parse(tmp_path, table, suffix, split={"method": "group", "column": column})
    groups = [set(rows.positions[:, 2].tolist()) for rows in subsets.values()]
    assert sum(map(len, groups)) == len(set.union(*groups)) == table[column].nunique()


def test_german_excel_is_read_and_logged(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    table = frame()
    text = table.to_csv(index=False, sep=";", decimal=",", lineterminator="\r\n")
    with caplog.at_level(logging.INFO, "softkin"):
        subsets = parse(tmp_path, text.encode("utf-8-sig"))
    np.testing.assert_array_equal(all_rows(subsets), all_rows(parse(tmp_path, table)))
    assert "read as utf-8-sig, columns split by semicolon, decimal commas" in caplog.text


def spoilt(change: Callable[[pd.DataFrame], Any], n_rows: int = 300) -> pd.DataFrame:
    table = frame(n_rows, n_markers=2)
    change(table)
    return table


@pytest.mark.parametrize(
    ("table", "changes", "says"),
    [
        (b"", {}, ["the file is empty"]),
        (b"\xd0\xcf\x11\xe0 xl/workbook.xml", {}, ["not readable as a workbook", "CSV UTF-8"]),
        (b"\x1f\x8b\x08 more", {}, ["gzip", "unpack"]),
        ("u1,u2,m1_x,m1_y,m1_z\n", {}, ["a header, but no row"]),
        ("u1,u2,m1_x,m1_y\n", {"dimensions": 2}, ["a header, but no row"]),
        (frame(1), {}, ["commands: 1 distinct command, but four subsets need at least four"]),
        (frame(10), {}, ["10 rows are too few", "of at least 20"]),
        (frame().drop(columns="u2"), {"commands": ["u1", "u2"]}, ["no column 'u2'", "u1, m1_x, m1_y, m1_z"]),
        (frame().drop(columns="m1_y"), {}, ["`positions`: 2 columns (m1_x, m1_z), but 3 per marker"]),
        (frame().rename(columns={"u2": "u1"}), {}, ["2 columns are named 'u1' (columns 1, 2)"]),
        (frame(), {"commands": "v.*"}, ["matches no whole name"]),
        (frame(), {"n_markers": 2}, ["`n_markers`: 2, but the columns of the entry make it 1"]),
        (frame(), {"split": {"method": "group", "column": "run"}}, ["`split`: no column 'run'"]),
        (spoilt(lambda t: t.__setitem__(("u1"), 1.0)).assign(u2=2.0), {}, ["1 distinct command"]),
        (spoilt(lambda t: t.loc.__setitem__((7, "m1_y"), np.nan)), {}, ["line 9, column 'm1_y': no value"]),
        (spoilt(lambda t: t.loc.__setitem__((7, "m1_y"), 1e200)), {}, ["line 9, column 'm1_y': too large a number"]),
        ("u1\n1\n2\n", {}, ["one column only", "`delimiter`"]),
        (frame().to_csv(index=False, header=False), {}, ["no header"]),
        (frame().to_csv(index=False, decimal=",").replace('"', ""), {}, ["10 values", "decimal commas"]),
        (frame().to_csv(index=False).encode("utf-16-be"), {}, ["UTF-16", "CSV UTF-8"]),
    ],
)  # fmt: skip
def test_a_bad_file_is_named_with_place_and_fix(
    tmp_path: Path, table: pd.DataFrame | str | bytes, changes: dict[str, Any], says: list[str]
) -> None:
    with pytest.raises(DataError) as error:
        parse(tmp_path, table, **changes)
    for part in ("dataset 'arm', file arm.csv", "\n  fix: ", *says):
        assert part in str(error.value)


@pytest.mark.parametrize(
    ("table", "changes", "says"),
    [
        (spoilt(lambda t: t.__setitem__("u2", 4.0)), {}, ["command 'u2' is always 4", "leave it out of `commands`"]),
        (spoilt(lambda t: t.__setitem__("u2", t["u1"])), {}, ["columns 'u1' and 'u2' hold the same numbers"]),
        (spoilt(lambda t: t.__setitem__("m2_y", t["m2_x"])), {}, ["columns 'm2_x' and 'm2_y' hold the same numbers"]),
        (frame(100), {}, ["validation has 7 rows", "19 or more"]),
        (spoilt(lambda t: t.update(t[["u1", "u2"]].round(0))), {}, ["subsets miss their share", "extrapolation"]),
        (frame(n_markers=3).assign(m3_x=frame()["m1_x"] / 1e3, m3_y=frame()["m1_y"] / 1e3, m3_z=0.1), {},
         ["mixed units?", "the marker of 'm2_x'", "that of 'm3_x'", "one unit"]),
        (frame(n_markers=3).assign(**{f"m2_{axis}": frame(n_markers=2)[f"m2_{axis}"] / 1e3 for axis in "xyz"}), {},
         ["mixed units?", "the marker of 'm3_x'", "that of 'm2_x'", "one unit"]),
        (frame().rename(columns={f"m1_{axis}": f"tip_{axis}_m" for axis in "xyz"}), {"positions": "tip.*"},
         ["the names of the columns say m, but `position_unit` says mm"]),
    ],
)  # fmt: skip
def test_a_suspicious_file_is_warned_of(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, table: pd.DataFrame, changes: dict[str, Any], says: list[str]
) -> None:
    parse(tmp_path, table, **changes)
    warnings = [record.getMessage() for record in caplog.records if record.levelno == logging.WARNING]
    assert len(warnings) == 1
    for part in ("dataset 'arm', file arm.csv: ", "\n  fix: ", *says):
        assert part in warnings[0]


SPLITS = [{"method": "random"}, {"method": "group", "column": "u1"}, {"method": "time", "column": "m1_x"}]


@given(
    values=arrays(float, st.tuples(st.integers(0, 70), st.just(5)), elements=st.floats(-1e100, 1e100)),
    suffix=st.sampled_from(["csv", "parquet"]),
    split=st.sampled_from(SPLITS),
)
def test_any_table_is_read_to_the_bit_or_refused(
    tmp_path_factory: pytest.TempPathFactory, values: Any, suffix: str, split: dict[str, str]
) -> None:
    table = pd.DataFrame(values, columns=["u1", "u2", "m1_x", "m1_y", "m1_z"])
    with contextlib.suppress(DataError):
        subsets = parse(tmp_path_factory.mktemp("any"), table, suffix, split=split)
        np.testing.assert_array_equal(all_rows(subsets), values[np.lexsort(values.T)])


def test_the_example_is_what_its_script_makes() -> None:
    script = EXAMPLE.with_name("make_bending_arm.py")
    made = subprocess.run([sys.executable, str(script)], capture_output=True, check=True).stdout
    assert made == EXAMPLE.read_bytes()
    assert len(made) < 100_000
    entry = {"file": str(EXAMPLE), "position_unit": "mm", "commands": "p[0-9]_bar", "positions": ".*_[xyz]"}
    subsets = read(EXAMPLE, dataset="arm", source=entry | {"split": {"method": "random"}})
    assert [len(rows) for rows in subsets.values()] == [336, 42, 42, 180]


def test_what_many_commands_cost_is_said(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    subsets = parse(tmp_path, frame(n_commands=256))
    assert subsets["train"].commands.shape[1] == 256
    (said,) = [record.getMessage() for record in caplog.records if record.levelno > logging.INFO]
    assert "256 commands: a fit of trees takes 4.0 times as long" in said
    assert "docs/scaling.md" in said
