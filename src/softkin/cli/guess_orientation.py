"""Which columns of a robot's own table are the orientation of its tip, by their numbers and names.

Four columns of unit norm are a quaternion: their names tell which of them is w, or a person is asked. Nine that are
rotation matrices in every row are one. Roll, pitch and yaw are told by their names alone, and their unit by the names
or by angles beyond a full turn, or a person is asked.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.cli import column_kinds
from softkin.cli.guess_questions import Question, words_of
from softkin.core.rotations import DEGREES, MATRIX, RADIANS, WXYZ, XYZW, are_none
from softkin.data.orientation import KEY

_COMPONENT = re.compile(r"(?:^|q|[^a-z])([wxyz])(?:$|[^a-z])")
#: Row and column of a matrix at the end of a name.
_ROW_COLUMN = re.compile(r"([0-3])[_,]?([0-3])\]?\)?$")
#: Roll, pitch and yaw as people call them, each with its place.
_ANGLES = (
    {"roll": 0, "pitch": 1, "yaw": 2},
    {"rpy_x": 0, "rpy_y": 1, "rpy_z": 2},
    {"rpy_r": 0, "rpy_p": 1, "rpy_y": 2},
)
_DEGREES, _RADIANS = re.compile(r"(?<![a-z])deg"), re.compile(r"(?<![a-z])rad")
#: Larger angles in radians are no orientation, which nobody writes beyond a full turn.
FULL_TURN = 2 * np.pi

Columns = Mapping[str, NDArray[Any]]


def matrices(names: Sequence[str], columns: Columns) -> list[str]:
    """Columns of numbers that stand nine in a row and are a rotation matrix, row by row, in all rows."""
    found: list[str] = []
    for first in range(len(names) - 8):
        nine = names[first : first + 9]
        if any(columns[name].dtype == object for name in nine) or set(nine) & set(found):
            continue
        values = np.column_stack([columns[name] for name in nine])
        values = values[~np.isnan(values).any(axis=1)]
        if len(values) > 1 and not are_none(values, MATRIX).any() and np.ptp(values, axis=0).max() > 0:
            found += nine
    return found


def rotations(names: Sequence[str], columns: Columns) -> list[str]:
    """Columns that are rotations by their numbers, whatever they are called."""
    return [*column_kinds.quaternions(names, columns), *matrices(names, columns)]


def orientation_key(names: Sequence[str], columns: Columns, answer: int | None) -> tuple[dict[str, Any], list[str]]:
    """The key `orientation` of the entry, where columns tell it or an `answer` (0 or 1) does, and what is to be
    checked.
    """
    found, why = orientation(names, columns)
    if len(found) > 1 and answer is None:
        return {}, [f"{why}; write it by hand"]
    return {KEY: found[min(answer or 0, len(found) - 1)]} if found else {}, [why] if why else []


def orientation(names: Sequence[str], columns: Columns) -> tuple[list[dict[str, Any]], str]:
    """What the entry may say as `orientation`, one or, where a person must choose, two; and what is to be checked.
    Nothing where no columns are an orientation, or those of several bodies: the entry takes the tip's alone.
    """
    for found, size, read in (
        (column_kinds.quaternions(names, columns), 4, _quaternion),
        (matrices(names, columns), 9, _matrix),
        (_angles(names, columns), 3, _roll_pitch_yaw),
    ):
        if len(found) > size:
            listed = ", ".join(found)
            return [], f"orientation: several ({listed}); write that of the tip by hand, see config/README.md"
        if found:
            return read(found, columns)
    return [], ""


def question_of_orientation(names: Sequence[str], columns: Columns) -> Question | None:
    """What a person is asked of the orientation; None where nothing is to be asked."""
    entries, why = orientation(names, columns)
    if len(entries) < 2:
        return None
    answers = [f"{entry['kind']} of {', '.join(entry['columns'])}" for entry in entries]
    return Question(f"{why.removeprefix('orientation: ')}: which is it?", (answers[0], answers[1]), ((), ()))


def _quaternion(found: list[str], _: Columns) -> tuple[list[dict[str, Any]], str]:
    """The quaternion in four columns: put in the order x, y, z, w where the names tell it."""
    components = {match.group(1): name for name in found if (match := _COMPONENT.search(name.lower()))}
    if len(components) == 4:
        named = [components[letter] for letter in "xyzw"]
        return [{"kind": XYZW, "columns": named}], "orientation: a quaternion, by unit norm and names"
    entries = [{"kind": kind, "columns": found} for kind in (WXYZ, XYZW)]
    return entries, f"orientation: {', '.join(found)} are a quaternion whose w is the first column or the last"


def _matrix(found: list[str], _: Columns) -> tuple[list[dict[str, Any]], str]:
    """A matrix reads as a rotation by columns, too, as its inverse: names such as r12 tell which it is."""
    places = [match.groups() for name in found if (match := _ROW_COLUMN.search(name))]
    if any(sorted(places) == [*product(numbers, repeat=2)] for numbers in ("012", "123")):
        named = [name for _, name in sorted(zip(places, found, strict=True))]
        return [{"kind": MATRIX, "columns": named}], "orientation: a rotation matrix, by its numbers and names"
    why = "orientation: nine columns are rotation matrices, taken row by row; please check"
    return [{"kind": MATRIX, "columns": found}], why


def _roll_pitch_yaw(found: list[str], columns: Columns) -> tuple[list[dict[str, Any]], str]:
    said = " ".join(found).lower()
    largest = max(np.nanmax(np.abs(columns[name])) for name in found)
    kinds = [RADIANS, DEGREES]
    if _DEGREES.search(said) or _RADIANS.search(said):
        kinds = [DEGREES if _DEGREES.search(said) else RADIANS]
    elif largest > FULL_TURN:
        kinds = [DEGREES]
    what = f"orientation: {', '.join(found)} are roll, pitch and yaw"
    why = f"{what} in radians or degrees, up to {largest:.3g}" if len(kinds) > 1 else f"{what}; please check"
    return [{"kind": kind, "columns": found} for kind in kinds], why


def _angles(names: Sequence[str], columns: Columns) -> list[str]:
    """Columns of roll, pitch and yaw in this order, of each body in turn."""
    for known in _ANGLES:
        found = sorted(
            (place, name)
            for name in names
            for word, place in known.items()
            if columns[name].dtype != object and _says(name, word) and not np.isnan(columns[name]).all()
        )
        if {place for place, _ in found} == {0, 1, 2}:
            return [name for _, name in found]
    return []


def _says(name: str, word: str) -> bool:
    return word in words_of(name) or word in re.sub(r"[^a-z]+", "_", name.lower())
