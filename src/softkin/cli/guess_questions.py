"""Questions that a robot's table raises, for a person to answer, and why columns are left out of its entry.

- A marker that is a turned, shifted or converted copy of another is in another frame or unit: which of the two is it?
- Columns of positions that are called desired, reference or target beside measured ones: are they commands, or nothing?
- Columns that a sensor measured beside those that the robot was told: are they commands, too, or nothing?
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.cli import column_kinds
from softkin.data.readers.columns import axis_of, family_of

#: Words of a column's name that say that it is what was wished for.
DESIRED = frozenset(["des", "desired", "ref", "reference", "target", "goal", "wanted", "setpoint"])
#: Words of a column's name that say that a sensor measured it; of forces along x, y and z one did.
MEASURED = frozenset(["meas", "measured", "actual", "sensor", "sensed", "feedback", "fb", "reading", "encoder"])
SENSED = frozenset(["force", "torque", "current", "tension", "load"])
#: Words of a column's name that say that it was measured by a camera.
PIXELS = frozenset(["img", "image", "px", "pixel", "pixels", "cam", "camera"])
FEWEST_ROWS = 12
#: Factors between units of length; a frame that is turned or shifted has one of these as its scale, this near.
SCALES = tuple(scale for unit in (1.0, 10.0, 100.0, 1000.0, 25.4, 2.54, 0.0254) for scale in (unit, 1 / unit))
SAME_SCALE = 1e-3
#: What columns are that say when a row was recorded, or which one it is, by the kind of their words.
LABELS = {"time": "a time", "group": "a label of rows", "subset": "a label of rows", "ignored": "a label of rows"}
#: The kind of what a question is about and the answer does not take.
ASKED = "asked"
LABELS[ASKED] = "what was asked: the answer takes the other"


@dataclass(frozen=True, slots=True)
class Question:
    """What is asked, and of either answer what it is called and which columns it leaves out; the second takes
    `as_commands` for commands.
    """

    text: str
    answers: tuple[str, str]
    left_out: tuple[tuple[str, ...], tuple[str, ...]]
    as_commands: tuple[str, ...] = ()


def words_of(name: str) -> set[str]:
    """The words of a column's name, in lower case."""
    return set(re.sub(r"[^a-z]+", " ", name.lower()).split())


def question_of(names: Sequence[str], columns: Mapping[str, NDArray[Any]]) -> Question | None:
    """The first question that a table raises by the names of its columns and what `columns` (n_rows,) hold; None."""
    families = _families([name for name in names if columns[name].dtype != object])
    desired = [name for name in names if words_of(name) & DESIRED and axis_of(name)]
    measured = [name for family in families for name in family if name not in desired]
    if desired and measured:
        listed = ", ".join(desired)
        return Question(
            f"{listed}: is that what the robot was told (commands), or a wish that it never saw?",
            ("not used", "commands"),
            (tuple(desired), ()),
            tuple(desired),
        )
    if (sensed := _sensed(names, columns)) is not None:
        return sensed
    for one, other in combinations([family for family in families if not set(family) & set(desired)], 2):
        if len(one) == len(other) and _same_in_another_frame(one, other, columns):
            first, second = ", ".join(one), ", ".join(other)
            return Question(
                f"{second} are {first} in another frame or unit: which of the two is the marker?",
                (first, second),
                (tuple(other), tuple(one)),
            )
    return None


def _sensed(names: Sequence[str], columns: Mapping[str, NDArray[Any]]) -> Question | None:
    """Whether measured values beside those that the robot was told are commands, too."""
    numbers = [name for name in names if columns[name].dtype != object]
    told = [name for name in numbers if column_kinds.kind_of(name) == "command"]
    forces = {name: axis[0] for name in told if words_of(name) & SENSED and (axis := axis_of(name))}
    found = [
        name
        for name in numbers
        if (column_kinds.kind_of(name) in ("command", None) and axis_of(name) is None and words_of(name) & MEASURED)
        or [*forces.values()].count(forces.get(name, "")) == 3
    ]
    others = [name for name in told if name not in found]
    if not found or not others:
        return None
    return Question(
        f"{', '.join(found)} were measured beside {', '.join(others)}: are they known, too, when a pose is predicted?",
        ("not used", "commands"),
        (tuple(found), ()),
        tuple(found),
    )


def reasons_left_out(names: Sequence[str], columns: Mapping[str, NDArray[Any]], kinds: Mapping[str, str | None]) -> str:
    """Why the columns `names` are no part of the entry, those of one reason together; `kinds` by their words."""
    by_reason: dict[str, list[str]] = {}
    for name in names:
        by_reason.setdefault(_reason(name, columns, kinds.get(name)), []).append(name)
    return "; ".join(f"{', '.join(alike)} ({reason})" for reason, alike in by_reason.items())


def _reason(name: str, columns: Mapping[str, NDArray[Any]], kind: str | None) -> str:
    if columns[name].dtype == object:
        return "text"
    if name in column_kinds.computed(list(columns)):
        return "a model's output or a difference, by its name"
    if name in column_kinds.quaternions(list(columns), columns):
        return "an orientation: four columns of unit norm"
    if kind == "no position":
        return "an orientation or a rate, by its name"
    if words_of(name) & MEASURED and axis_of(name) is None:
        return "measured and not told, by its name"
    if words_of(name) & DESIRED:
        return "desired and not measured, by its name"
    if column_kinds.is_running(columns[name]):
        return "a running number"
    if kind is None and axis_of(name) is not None:
        return "a position without its other axes, or one that is not used"
    if not name:
        return "a column without a name"
    return LABELS.get(str(kind), "neither a command nor a position, by its name")


def _families(names: Sequence[str]) -> list[list[str]]:
    """Columns of one marker each, by the axes that their names tell, in the order of the file."""
    found: dict[str, list[str]] = {}
    for name in names:
        if family := family_of(name):
            found.setdefault(family[0], []).append(name)
    return [family for family in found.values() if 2 <= len(family) <= 3]


def _same_in_another_frame(one: Sequence[str], other: Sequence[str], columns: Mapping[str, NDArray[Any]]) -> bool:
    first, second = (np.column_stack([columns[name] for name in family]) for family in (one, other))
    whole = ~np.isnan(np.hstack([first, second])).any(axis=1)
    if whole.sum() < FEWEST_ROWS:
        return False
    first, second = first[whole] - first[whole].mean(axis=0), second[whole] - second[whole].mean(axis=0)
    if not column_kinds.affine_copies(first, second):
        return False
    stretches = np.linalg.svd(np.linalg.lstsq(first, second, rcond=None)[0])[1]
    return any(np.abs(stretches / scale - 1).max() < SAME_SCALE for scale in SCALES)
