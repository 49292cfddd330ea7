from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.cli.guess_entry import asked, guess_entry
from softkin.cli.guess_questions import ASKED, question_of, reasons_left_out, words_of
from tests.conftest import HOUSE
from tests.unit.cli.tables import columns


def of(table: pd.DataFrame) -> dict[str, np.ndarray]:
    return {name: table[name].to_numpy() for name in table}


def test_a_plain_table_raises_no_question() -> None:
    table = columns("u1", "u2", "a_x", "a_y", "a_z", "b_x", "b_y", "b_z")
    assert question_of(list(table), of(table)) is None


def test_case_21_two_frames_of_one_marker_are_a_question() -> None:
    path = HOUSE / "tests" / "cases" / "21_pixels_two_frames.csv"
    question = asked(path)
    assert question is not None
    assert "another frame or unit" in question.text
    entries = [guess_entry(path, "Arm", "arm.csv", None, answer) for answer in (0, 1)]
    assert [entry["positions"] for entry, _ in entries] == [["tip_x", "tip_y"], ["tip_x_img", "tip_y_img"]]
    assert any("pixels" in reason for reason in entries[1][1])
    assert [entry["position_unit"] for entry, _ in entries] == ["mm", "px"]
    assert any("px if these are pixels, as 'tip_x_img' seems to be" in reason for reason in entries[0][1])


def test_desired_positions_are_commands_or_nothing(tmp_path: Path) -> None:
    table = columns("u1", "u2", "x", "y", "z")
    for axis in "xyz":
        table[f"{axis}_desired"] = table[axis] + np.random.default_rng(0).normal(size=len(table))
    path = tmp_path / "arm.csv"
    table.to_csv(path, index=False)
    wished = ["x_desired", "y_desired", "z_desired"]
    assert asked(path) is not None
    first, why = guess_entry(path, "Arm", "arm.csv")
    second, _ = guess_entry(path, "Arm", "arm.csv", None, 1)
    assert (first["commands"], first["positions"]) == (["u1", "u2"], ["x", "y", "z"])
    assert f"left out: {', '.join(wished)} (desired and not measured, by its name)" in why
    assert (second["commands"], second["positions"]) == (["u1", "u2", *wished], ["x", "y", "z"])


@pytest.mark.parametrize(
    ("file", "left", "reason"),
    [
        ("01_residual_columns.csv", "dx", "a model's output or a difference"),
        ("05_rpy_and_quaternion_xyz.csv", "rpy_x", "an orientation or a rate"),
        ("14_text_columns.csv", "action_name", "text"),
    ],
)
def test_what_is_left_out_of_a_case_says_why(file: str, left: str, reason: str) -> None:
    _, reasons = guess_entry(HOUSE / "tests" / "cases" / file, "Arm", file)
    (said,) = [text for text in reasons if text.startswith("left out")]
    assert reason in said[said.index(left) :]


def test_columns_of_one_reason_stand_together() -> None:
    table = columns("u1").assign(t=1.0, trial=2.0, odd=3.0)
    said = reasons_left_out(["t", "trial", "odd"], of(table), {"t": "time", "trial": "group", "odd": None})
    assert said == "t (a time); trial (a label of rows); odd (neither a command nor a position, by its name)"
    answered = reasons_left_out(["odd"], of(table), {"odd": ASKED})
    assert answered == "odd (what was asked: the answer takes the other)"
    assert words_of("Tip_X-img[px]") == {"tip", "x", "img", "px"}


@pytest.mark.parametrize(
    ("told", "sensed"),
    [
        (["p1_set", "p2_set"], ["p1_meas", "p2_meas"]),
        (["pressure_cmd_1", "pressure_cmd_2"], ["pressure_sensor_1", "pressure_sensor_2"]),
        (["u1", "u2"], ["force_x", "force_y", "force_z"]),
    ],
)
def test_what_was_measured_beside_what_was_told_is_a_question(
    tmp_path: Path, told: list[str], sensed: list[str]
) -> None:
    rng = np.random.default_rng(0)
    names = [*told, *sensed, "x", "y", "z"]
    pd.DataFrame(rng.uniform(20, 90, (60, len(names))), columns=names).to_csv(tmp_path / "arm.csv", index=False)
    question = asked(tmp_path / "arm.csv")
    assert question is not None
    assert question.text.startswith(", ".join(sensed))
    entries = [guess_entry(tmp_path / "arm.csv", "Arm", "arm.csv", None, answer)[0] for answer in (0, 1)]
    assert [entry["commands"] for entry in entries] == [told, [*told, *sensed]]
    assert all(entry["positions"] == ["x", "y", "z"] for entry in entries)


def test_one_marker_in_two_units_is_a_question(tmp_path: Path) -> None:
    table = columns("u1", "u2", "x", "y", "z")
    table = table.assign(**{f"{axis}_m": table[axis] / 1000 for axis in "xyz"})
    table.to_csv(tmp_path / "arm.csv", index=False)
    question = asked(tmp_path / "arm.csv")
    assert question is not None
    assert "another frame or unit" in question.text
