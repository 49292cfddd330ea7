from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.cli.guess_entry import LARGEST_METRES, guess_entry
from softkin.core.errors import DataError
from softkin.data.readers import table_file
from tests.conftest import HOUSE
from tests.unit.cli.tables import SIZE, columns


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        (columns("u1", "u2", "x", "y", "z"), {"commands": ["u1", "u2"], "positions": ["x", "y", "z"]}),
        (columns("p1_bar", "p2_bar", "a_x", "b_x", "a_y", "b_y", "a_z", "b_z"),
         {"commands": ["p1_bar", "p2_bar"], "positions": ["a_x", "a_y", "a_z", "b_x", "b_y", "b_z"]}),
        (columns("u1", "u2", "x", "y"), {"positions": ["x", "y"], "dimensions": 2}),
        (columns("u_x", "u_y", "x", "y"), {"commands": ["u_x", "u_y"], "positions": ["x", "y"], "dimensions": 2}),
        (columns("u1", "tip_x", "tip_z"), {"positions": ["tip_x", "tip_z"], "dimensions": 2}),
        (columns("p_x", "p_y", "p_z").assign(left=columns("u1")), {"commands": ["left"]}),
        (columns("u1", "x", "y", "z", scale=1e-3), {"position_unit": "m"}),
        (columns("u1", "x", "y", "z"), {"position_unit": "mm", "split": {"method": "random"}}),
        (columns("u1", "x [cm]", "y [cm]", "z [cm]"), {"position_unit": "cm"}),
        (columns("u1", "u2", "x", "y", "z").assign(time=np.arange(SIZE) / 50.0),
         {"split": {"method": "time", "column": "time"}, "commands": ["u1", "u2"]}),
        (columns("u1", "x", "y", "z").assign(Trial=np.arange(SIZE) // 10, t=1.0),
         {"split": {"method": "group", "column": "Trial"}}),
        (columns("u1", "x", "y", "z").assign(subset=["train", "val", "test", "ext"] * (SIZE // 4)),
         {"split": {"method": "column", "column": "subset"}}),
        (columns("u1", "x", "y", "z").assign(subset=["left", "right"] * (SIZE // 2)), {"split": {"method": "random"}}),
        (columns("u1", "x", "y", "z").assign(qx=1.0, yaw=2.0, frame=3, rot_x=1, rot_y=2, rot_z=3),
         {"commands": ["u1"], "positions": ["x", "y", "z"]}),
    ],
)  # fmt: skip
def test_columns_units_and_split_are_guessed(tmp_path: Path, table: pd.DataFrame, expected: dict[str, Any]) -> None:
    table.to_csv(tmp_path / "arm.csv", index=False)
    entry, _ = guess_entry(tmp_path / "arm.csv", "Soft arm", "data/arm.csv")
    assert {key: entry.get(key) for key in expected} == expected
    assert (entry["title"], entry["format"], entry["file"]) == ("Soft arm", "table_file", "data/arm.csv")


def test_the_entry_reads_the_file_that_it_was_guessed_from(tmp_path: Path) -> None:
    path = tmp_path / "arm.parquet"
    columns("p1", "p2", "x", "y").assign(id=np.arange(SIZE)).to_parquet(path, index=False)
    entry, reasons = guess_entry(path, "Arm", str(path))
    subsets = table_file.read(path, dataset="arm", source=entry)
    assert sum(map(len, subsets.values())) == SIZE
    assert any(reason.startswith("dimensions: ") for reason in reasons)
    assert "left out: id (a running number)" in reasons


def test_each_guess_has_its_reason(tmp_path: Path) -> None:
    table = columns("x", "y", "z").assign(left=columns("u1"), right=columns("u1"))
    table.to_csv(tmp_path / "arm.csv", index=False)
    entry, reasons = guess_entry(tmp_path / "arm.csv", "Arm", "arm.csv")
    assert entry["commands"] == ["left", "right"]
    assert [reason.split(":")[0] for reason in reasons] == ["commands", "position_unit", "split"]
    assert reasons[0].endswith("please check")


@pytest.mark.parametrize(("factor", "unit"), [(0.99, "m"), (1.01, "mm")])
def test_a_wide_workspace_is_in_mm(tmp_path: Path, factor: float, unit: str) -> None:
    widths = np.linspace(0.0, factor * LARGEST_METRES, SIZE)
    columns("u1").assign(x=widths, y=0.1, z=0.2).to_csv(tmp_path / "arm.csv", index=False)
    assert guess_entry(tmp_path / "arm.csv", "Arm", "arm.csv")[0]["position_unit"] == unit


@pytest.mark.parametrize(
    ("content", "what"),
    [
        ("u1,x,y,z\n", "a header, but no row"),
        ("u1,a,b\n1,2,3\n", "no columns look like positions: u1, a, b"),
        ("t,x,y,z\n1,2,3,4\n", "no column looks like a command: t, x, y, z"),
        ("u1,x_m,y_mm,z_mm\n1,2,3,4\n", "positions in different units: x_m, y_mm, z_mm"),
    ],
)
def test_columns_that_tell_nothing_are_an_error(tmp_path: Path, content: str, what: str) -> None:
    path = tmp_path / "arm.csv"
    path.write_text(content)
    with pytest.raises(DataError, match=what) as raised:
        guess_entry(path, "Arm", "arm.csv")
    assert raised.value.where == str(path)
    assert raised.value.fix


def test_columns_of_time_and_session_are_guessed(tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    frame = columns("u1", "u2", "x", "y", "z").assign(time=range(SIZE), run=[1] * 120 + [2] * 80)
    frame.to_csv(path, index=False)
    entry, reasons = guess_entry(path, "Arm", "arm.csv")
    assert (entry["order"], entry["session"]) == ("time", "run")
    assert any("order, session: guessed" in reason for reason in reasons)
    blank = frame["time"].where(frame["time"] != 7)
    for spoilt in (frame.assign(run=[1, 2] * 100), frame.assign(time=blank)):
        spoilt.to_csv(path, index=False)
        entry, reasons = guess_entry(path, "Arm", "arm.csv")
        assert "order" not in entry
        assert any("left out, since time and run are none" in reason for reason in reasons)


def test_the_guess_is_made_though_the_file_is_not_readable_to_its_end(tmp_path: Path) -> None:
    table = columns("u1", "u2", "x", "y", "z").astype(object)
    table.loc[150, "z"] = "broken"
    table.to_csv(tmp_path / "arm.csv", index=False)
    entry, reasons = guess_entry(tmp_path / "arm.csv", "Arm", "arm.csv")
    assert (entry["commands"], entry["positions"]) == (["u1", "u2"], ["x", "y", "z"])
    assert any("not readable to its end" in reason for reason in reasons)


def test_rows_that_follow_each_other_are_a_recording_though_no_column_says_so(tmp_path: Path) -> None:
    turns = np.linspace(0, 12, SIZE)
    table = columns("x", "y", "z").assign(u1=np.sin(turns), u2=np.cos(1.7 * turns))
    table.to_csv(tmp_path / "arm.csv", index=False)
    _, reasons = guess_entry(tmp_path / "arm.csv", "Arm", "arm.csv")
    assert any("rows in turn are alike" in reason for reason in reasons)


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (["count", "a", "b", "x", "y", "z"], {"commands": ["a", "b"], "positions": ["x", "y", "z"]}),
        (["X_train_1", "X_train_2", "y_train_1", "y_train_2", "y_train_3"], {"commands": ["X_train_1", "X_train_2"]}),
        (["u_1", "u_2", "p_1", "p_2", "p_3"], {"commands": ["u_1", "u_2"], "positions": ["p_1", "p_2", "p_3"]}),
        (["u1", "rotvec_x", "rotvec_y", "rotvec_z", "x", "y", "z"], {"commands": ["u1"], "positions": ["x", "y", "z"]}),
        (["u1", "mag_x", "mag_y", "mag_z", "x", "y", "z"], {"commands": ["u1"], "positions": ["x", "y", "z"]}),
        (["motor_angle_1", "motor_angle_2", "x", "y", "z"], {"commands": ["motor_angle_1", "motor_angle_2"]}),
        (["('cmd', 'u')", "('tip', 'x')", "('tip', 'y')", "('tip', 'z')"], {"commands": ["('cmd', 'u')"]}),
        (["u1", "x", "y", "z", "x_model", "y_model", "z_model"], {"positions": ["x", "y", "z"]}),
    ],
)
def test_names_are_not_taken_for_what_they_are_not(tmp_path: Path, names: list[str], expected: dict[str, Any]) -> None:
    rng = np.random.default_rng(0)
    table = pd.DataFrame(rng.uniform(20, 90, (60, len(names))), columns=names)
    if "count" in names:
        table["count"] = np.arange(60)
    table.to_csv(tmp_path / "arm.csv", index=False)
    entry, _ = guess_entry(tmp_path / "arm.csv", "Arm", "arm.csv")
    assert {key: entry[key] for key in expected} == expected


def test_text_and_a_tracker_alone_are_said(tmp_path: Path) -> None:
    (tmp_path / "arm.csv").write_text("u1,x,y,z\n6.0 kPa,1,2,3\n7.0 kPa,2,3,4\n")
    with pytest.raises(DataError, match=r"'u1' holds text: '6\.0 kPa'"):
        guess_entry(tmp_path / "arm.csv", "Arm", "arm.csv")
    with pytest.raises(DataError) as raised:
        guess_entry(HOUSE / "tests" / "cases" / "06_motive_export.csv", "Arm", "arm.csv")
    assert "POSITIONS=take.csv" in str(raised.value.fix)


def test_a_workspace_of_some_centimetres_may_be_in_either(tmp_path: Path) -> None:
    columns("u1", "x", "y", "z", scale=1.0).clip(upper=20.0).to_csv(tmp_path / "arm.csv", index=False)
    entry, reasons = guess_entry(tmp_path / "arm.csv", "Arm", "arm.csv")
    assert entry["position_unit"] == "mm"
    assert any("cm is possible, too" in reason for reason in reasons)


@pytest.mark.parametrize(
    ("names", "row", "unit"),
    [
        ("x_inch y_inch z_inch", "", "in"),
        ("x y z", "inches inches inches", "in"),
        ("x y z", "millimeters millimeters millimeters", "mm"),
        ("x y z", "px px px", "px"),
        ("x_um y_um z_um", "", None),
        ("x y z", "µm µm µm", None),
        ("x [feet]/y [feet]/z [feet]", "", None),
    ],
)
def test_a_unit_that_is_told_is_never_replaced_by_a_guess(
    tmp_path: Path, names: str, row: str, unit: str | None
) -> None:
    columns_named = names.split("/") if "/" in names else names.split()
    lines = [",".join(["u1", *columns_named])] + ([",".join(["bar", *row.split()])] if row else [])
    rng = np.random.default_rng(0)
    lines += [",".join(map(str, line)) for line in rng.uniform(10, 90, (40, 4)).round(3).tolist()]
    (tmp_path / "arm.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    if unit is None:
        with pytest.raises(DataError, match="is none of m, cm, mm, in"):
            guess_entry(tmp_path / "arm.csv", "Arm", "arm.csv")
    else:
        assert guess_entry(tmp_path / "arm.csv", "Arm", "arm.csv")[0]["position_unit"] == unit
