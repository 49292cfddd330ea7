from __future__ import annotations

import numpy as np
import pytest

from softkin.cli.guess_entry import asked, guess_entry
from softkin.cli.guess_orientation import matrices, orientation, question_of_orientation
from softkin.core.rotations import to_numbers
from tests.conftest import HOUSE

VECTORS = 0.5 * np.random.default_rng(0).standard_normal((30, 3))
CASES = HOUSE / "tests" / "cases"


def columns(kind: str, *names: str) -> dict[str, np.ndarray]:
    return dict(zip(names, to_numbers(VECTORS, kind).T, strict=True))


@pytest.mark.parametrize(
    ("names", "named"),
    [
        (("tip_qw", "tip_qx", "tip_qy", "tip_qz"), ["tip_qx", "tip_qy", "tip_qz", "tip_qw"]),
        (("arm_rotation_w", "arm_rotation_x", "arm_rotation_y", "arm_rotation_z"), None),
        (("W", "X", "Y", "Z"), ["X", "Y", "Z", "W"]),
    ],
)
def test_names_tell_the_order_of_a_quaternion(names: tuple[str, ...], named: list[str] | None) -> None:
    found = columns("quaternion_wxyz", *names)
    entries, why = orientation(list(found), found)
    assert entries == [{"kind": "quaternion_xyzw", "columns": named or [*names[1:], names[0]]}]
    assert "by unit norm and names" in why


def test_numbered_columns_of_a_quaternion_are_a_question_with_both_entries() -> None:
    path = CASES / "02_quaternion_q0_q3.csv"
    question = asked(path)
    assert question is not None
    assert "w is the first column or the last: which is it?" in question.text
    assert question.answers[1] == "quaternion_xyzw of q0, q1, q2, q3"
    entries = [guess_entry(path, "Arm", "arm.csv", None, answer)[0] for answer in (0, 1)]
    assert [entry["orientation"]["kind"] for entry in entries] == ["quaternion_wxyz", "quaternion_xyzw"]
    assert all(entry["commands"] == ["valve1", "valve2"] for entry in entries)


def test_a_quaternion_goes_before_angles_which_are_left_out_and_said_to_be() -> None:
    entry, reasons = guess_entry(CASES / "05_rpy_and_quaternion_xyz.csv", "Arm", "arm.csv")
    assert entry["orientation"]["columns"] == [f"quaternion_{letter}" for letter in "xyzw"]
    assert "left out: rpy_x, rpy_y, rpy_z (an orientation or a rate, by its name)" in reasons


@pytest.mark.parametrize(
    ("kind", "names", "kinds"),
    [
        ("roll_pitch_yaw_degrees", ("roll", "pitch", "yaw"), ["roll_pitch_yaw_degrees"]),
        ("roll_pitch_yaw_radians", ("roll_rad", "pitch_rad", "yaw_rad"), ["roll_pitch_yaw_radians"]),
        ("roll_pitch_yaw_radians", ("rpy_x", "rpy_y", "rpy_z"), ["roll_pitch_yaw_radians", "roll_pitch_yaw_degrees"]),
    ],
)
def test_angles_are_told_by_names_and_their_unit_by_names_or_size(
    kind: str, names: tuple[str, ...], kinds: list[str]
) -> None:
    found = columns(kind, *names)
    entries, _ = orientation(list(found), found)
    assert [entry["kind"] for entry in entries] == kinds
    assert all(entry["columns"] == list(names) for entry in entries)
    assert (question_of_orientation(list(found), found) is not None) == (len(kinds) == 2)


def test_nine_columns_that_are_rotations_are_a_matrix() -> None:
    found = columns("rotation_matrix", *(f"r{place}" for place in range(9)))
    assert matrices(["u", *found], {"u": VECTORS[:, 0], **found}) == list(found)
    assert orientation(list(found), found)[0] == [{"kind": "rotation_matrix", "columns": list(found)}]
    assert matrices(list(found), {name: 2 * column for name, column in found.items()}) == []


def test_several_bodies_are_said_and_not_guessed() -> None:
    one, other = (columns("quaternion_xyzw", *(f"{body}_q{letter}" for letter in "xyzw")) for body in ("mid", "tip"))
    entries, why = orientation([*one, *other], one | other)
    assert entries == []
    assert "several (mid_qx" in why
    assert orientation(["a"], {"a": VECTORS[:, 0]}) == ([], "")


@pytest.mark.parametrize("names", [[f"r{row}{column}" for column in "123" for row in "123"], None])
def test_names_tell_rows_and_columns_of_a_matrix(names: list[str] | None) -> None:
    by_row = [f"R[{row},{column}]" for row in "012" for column in "012"]
    values = to_numbers(VECTORS, "rotation_matrix")
    if names is None:
        found = dict(zip(by_row, values.T, strict=True))
    else:
        found = dict(zip(names, values[:, [0, 3, 6, 1, 4, 7, 2, 5, 8]].T, strict=True))
    entries, why = orientation(list(found), found)
    assert [entry["columns"] for entry in entries] == [sorted(found)]
    assert why == "orientation: a rotation matrix, by its numbers and names"
