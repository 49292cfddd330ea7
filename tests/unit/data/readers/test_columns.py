from __future__ import annotations

from typing import Any

import pytest

from softkin.core.errors import DataError
from softkin.data.readers.columns import axis_of, check, choose, family_of, marker_by_marker, orientations, unit_of

NAMES = ["t", "u1", "u2", "m1_x", "m1_y", "m1_z", "m2_x", "m2_y", "m2_z", "note", "note"]


@pytest.mark.parametrize(
    ("name", "axis"),
    [
        ("x", ("", "x")),
        ("m2_y", ("m2_", "y")),
        ("z10", ("10", "z")),
        ("Tip X", ("Tip ", "x")),
        ("markerY [mm]", ("marker ", "y")),
        ("pos.x_m", ("pos.", "x")),
        ("max", None),
        ("MAX", None),
        ("extra", None),
        ("qx", None),
        ("xy", None),
        ("x_y", None),
        ("u1", None),
    ],
)
def test_axes_are_read_off_names(name: str, axis: tuple[str, str] | None) -> None:
    assert axis_of(name) == axis


@pytest.mark.parametrize(
    ("name", "unit"),
    [("x_mm", "mm"), ("x [m]", "m"), ("x(cm)", "cm"), ("x.in", "in"), ("x m", "m"), ("x", None), ("arm", None)],
)
def test_units_are_read_off_names(name: str, unit: str | None) -> None:
    assert unit_of(name) == unit


@pytest.mark.parametrize(
    ("wanted", "places"),
    [
        (["u2", "u1"], [2, 1]),
        ([" u1 "], [1]),
        ("u1", [1]),
        ("u[0-9]+", [1, 2]),
        ("m.*", [3, 4, 5, 6, 7, 8]),
        ("(t|u2)", [0, 2]),
    ],
)
def test_columns_are_chosen_by_name_or_pattern(wanted: Any, places: list[int]) -> None:
    assert choose(NAMES, wanted, "commands") == places


def test_a_name_with_signs_of_patterns_is_a_name_first() -> None:
    assert choose(["p (bar)", "p"], "p (bar)", "commands") == [0]


@pytest.mark.parametrize(
    ("wanted", "says"),
    [
        (["u3"], ["no column 'u3'", "the columns t, u1"]),
        ("v[0-9]", ["'v[0-9]' matches no whole name", "the columns t, u1"]),
        ("u[0-9", ["'u[0-9' is no pattern"]),
        (["note"], ["2 columns are named 'note' (columns 10, 11)", "give each its own name"]),
        ("n.*", ["2 columns are named 'note'"]),
    ],
)
def test_a_wrong_choice_is_an_error(wanted: Any, says: list[str]) -> None:
    with pytest.raises(DataError) as error:
        choose(NAMES, wanted, "commands")
    for part in ("`commands`", "\n  fix: ", *says):
        assert part in str(error.value)


@pytest.mark.parametrize(
    ("commands", "coordinates", "dimensions"),
    [
        (["u1"], ["x", "y", "z"], 3),
        (["u1"], ["a", "b", "c"], 3),
        (["u1"], ["x1", "x2", "x3"], 3),  # x for position
        (["u1"], ["x1", "z1", "y1", "x2", "z2", "y2"], 3),  # a frame of one's own
        (["u1"], ["x1", "y1", "x2", "y2", "x3", "y3"], 2),
        ([f"u{place}" for place in range(64)], ["x", "z"], 2),
    ],
)
def test_good_choices_pass(commands: list[str], coordinates: list[str], dimensions: int) -> None:
    check(commands, coordinates, dimensions, {"n_commands": len(commands), "n_markers": len(coordinates) // dimensions})


@pytest.mark.parametrize(
    ("commands", "coordinates", "dimensions", "says"),
    [
        (["u1", "u1"], ["x", "y", "z"], 3, ["'u1' is chosen twice"]),
        (["x"], ["x", "y", "z"], 3, ["'x' is chosen twice"]),
        ([f"u{place}" for place in range(257)], ["x", "y", "z"], 3, ["257 columns, but at most 256"]),
        (["u1"], ["x", "y"], 3, ["2 columns (x, y), but 3 per marker", "dimensions: 2"]),
        (["u1"], ["x1", "y1", "x2", "y2", "x3", "y3"], 3, ["name the axes x, y", "write dimensions: 2"]),
        (["u1"], ["x1", "x2", "y1", "y2", "z1", "z2"], 3, ["x1, x2, y1 would be one", "[x1, y1, z1, x2, y2, z2]"]),
        (["u1"], ["x1", "x2", "y1", "y2"], 2, ["x1, x2 would be one marker", "[x1, y1, x2, y2]"]),
    ],
)
def test_columns_that_are_no_markers_are_an_error(
    commands: list[str], coordinates: list[str], dimensions: int, says: list[str]
) -> None:
    with pytest.raises(DataError) as error:
        check(commands, coordinates, dimensions, {})
    for part in ("\n  fix: ", *says):
        assert part in str(error.value)


@pytest.mark.parametrize("key", ["n_commands", "n_markers"])
def test_another_number_than_registered_is_an_error(key: str) -> None:
    with pytest.raises(DataError, match=f"`{key}`: 7, but the columns of the entry make it 1"):
        check(["u"], ["x", "y", "z"], 3, {key: 7})


def test_marker_by_marker_keeps_the_order_of_markers() -> None:
    assert marker_by_marker(["tip_z", "base_x", "tip_x", "base_z"]) == ["tip_x", "tip_z", "base_x", "base_z"]


def test_orientations_are_told_by_their_names() -> None:
    """Not by a letter alone: q1 may be a joint."""
    oriented = ["tip_qw", "roll", "rpy_x", "quaternion_w", "Rotation Y"]
    assert orientations([*oriented, "tip_x", "q1", "u1", "p_rob"]) == oriented


@pytest.mark.parametrize(
    "names",
    ["px py pz", "Px Py Pz", "xpos ypos zpos", "xTip yTip zTip", "posx posy posz", "xmm ymm zmm", "x/mm y/mm z/mm"],
)
def test_axes_in_one_word_with_what_they_are_of(names: str) -> None:
    families = [family_of(name) for name in names.split()]
    assert [family and family[1] for family in families] == ["x", "y", "z"]
    assert len({family and family[0] for family in families}) == 1


@pytest.mark.parametrize("name", ["vx", "ax", "Tx", "Fx", "qx", "mx", "max", "exp", "index", "cpx"])
def test_other_letters_before_an_axis_say_something_else(name: str) -> None:
    assert axis_of(name) is None


def test_units_and_cases_part_families() -> None:
    assert family_of("x") != family_of("x_m")
    assert family_of("x", by_unit=False) == family_of("x_m", by_unit=False)
    assert family_of("X_1") != family_of("x_1")
    assert unit_of("xmm") == "mm"
    assert unit_of("x/cm") == "cm"
    assert unit_of("exmm") is None
