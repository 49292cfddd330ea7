"""What columns of a robot's own table are, by their names and numbers: orientations, differences, running numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.data.readers.columns import ORIENTATION_WORDS

#: Words of a column's name, by the kind of column that they say; the first kind that has one of the words counts.
WORDS = {
    "subset": "subset split",
    "group": "group trial run episode sequence session trajectory experiment repetition",
    "time": "t time timestamp stamp datetime date elapsed",
    "no position": f"{ORIENTATION_WORDS} rx ry rz gyro omega angular angle vel velocity acc accel acceleration"
    " mag magnetometer",
    "ignored": "index idx id row frame sample n no qx qy qz qw",
    "command": "u p q cmd command act actuation actuator input pressure chamber tendon cable force tension motor torque"
    " voltage current servo valve spool setpoint control",
}
#: Words of what a robot is told by, whose angle or rate may be the command.
TOLD = frozenset([*WORDS["command"].split(), "joint", "steering", "crank", "tendons", "motors", "servos"])
#: Words of a column's name that say that it is computed from others: a model's output, or a difference to it.
COMPUTED = frozenset(
    [
        "pcc",
        "model",
        "pred",
        "predicted",
        "prediction",
        "sim",
        "simulated",
        "est",
        "estimated",
        "err",
        "error",
        "residual",
        "diff",
        "delta",
    ]
)
_DIFFERENCE = re.compile(r"(d|err|error|res)_?([xyz])")
#: Four columns are an orientation where their squares sum to 1 within this, in all rows.
UNIT_NORM = 0.02
#: Rows follow each other where neighbours differ by less than this share of what any two rows differ by.
ALIKE = 0.2
#: So many rows that grow one after the other do not do so by chance.
FEWEST_RISING = 12
#: Positions that commands give by an affine map to this share of their range are no measurement.
AFFINE = 1e-4


def kind_of(name: str) -> str | None:
    """What a column is by the words of its name, ignored without any; None where no word is known."""
    plain = re.sub(r"[^a-z]+", " ", re.split(r"[\[(]", name.lower().lstrip("[( "))[0]).split()
    if not plain:
        return "ignored"
    return next((kind for kind, known in WORDS.items() if {*plain, "".join(plain)}.intersection(known.split())), None)


def computed(names: Sequence[str]) -> list[str]:
    """Columns that are differences or outputs of a model, by their names."""
    differences = {name: match.group(1) for name in names if (match := _DIFFERENCE.fullmatch(name.lower()))}
    families = {stem for stem in differences.values() if list(differences.values()).count(stem) >= 2}
    words = {name: set(re.sub(r"[^a-z]+", " ", name.lower()).split()) for name in names}
    return [name for name in names if words[name] & COMPUTED or differences.get(name) in families]


def quaternions(names: Sequence[str], columns: Mapping[str, NDArray[Any]]) -> list[str]:
    """Columns of numbers that stand four in a row and are of unit norm in all rows, and none of them more so by itself:
    a quality of 1 beside a marker that moves by centimetres, in metres, is nearly of unit norm, too.
    """
    found: list[str] = []
    for first in range(len(names) - 3):
        four = names[first : first + 4]
        if any(columns[name].dtype == object for name in four) or set(four) & set(found):
            continue
        values = np.column_stack([columns[name] for name in four])
        values = values[~np.isnan(values).any(axis=1)]
        if len(values) < 2 or np.ptp(values, axis=0).max() <= UNIT_NORM:
            continue
        off = np.abs(np.linalg.norm(values, axis=1) - 1).max()
        if off < UNIT_NORM and off < np.abs(np.abs(values) - 1).max(axis=0).min():
            found += four
    return found


def numbered_positions(names: Sequence[str]) -> list[str]:
    """Three columns of one stem that are numbered one after the other, such as y1, y2, y3; none where there are none or
    several.
    """
    stems: dict[str, list[str]] = {}
    for name in names:
        if match := re.fullmatch(r"(.*?)_?(\d+)", name):
            stems.setdefault(match.group(1), []).append(name)
    triples = [family for family in stems.values() if len(family) == 3]
    return triples[0] if len(triples) == 1 else []


def is_running(column: NDArray[Any]) -> bool:
    """Whether a column is a running number: whole, each larger than the one before."""
    if column.dtype == object or len(column) < 3:
        return False
    return bool((np.diff(column) > 0).all() and (column == np.round(column)).all())


def running_number(kinds: Mapping[str, str | None], columns: Mapping[str, NDArray[Any]]) -> str | None:
    """The first column that is a running number by its name (its kind is `ignored`) and its numbers; None without."""
    return next((name for name in kinds if kinds[name] == "ignored" and is_running(columns[name])), None)


def rising(names: Sequence[str], columns: Mapping[str, NDArray[Any]]) -> str | None:
    """The first column of numbers that grows from row to row, as a time does; None without."""
    for name in names:
        column = columns[name]
        if column.dtype != object and len(column) >= FEWEST_RISING and (np.diff(column) > 0).all():
            return name
    return None


def are_alike(values: Array) -> bool:
    """Whether rows (n_rows, n_columns) that follow each other are alike, as those of a trajectory are."""
    values = values[~np.isnan(values).any(axis=1)]
    spread = values.std(axis=0)
    scaled = values[:, spread > 0] / spread[spread > 0]
    if len(scaled) < 3 or not scaled.size:
        return False
    shuffled = scaled[np.random.default_rng(0).permutation(len(scaled))]
    steps, jumps = (np.median(np.linalg.norm(np.diff(rows, axis=0), axis=1)) for rows in (scaled, shuffled))
    return bool(steps < ALIKE * jumps)


def affine_copies(commands: Array, positions: Array) -> bool:
    """Whether an affine map of the commands gives the positions nearly exactly."""
    whole = ~np.isnan(np.hstack([commands, positions])).any(axis=1)
    commands, positions = commands[whole], positions[whole]
    if len(commands) < 3 * (commands.shape[1] + 1):
        return False
    inputs = np.column_stack([np.ones(len(commands)), commands])
    errors = positions - inputs @ np.linalg.lstsq(inputs, positions, rcond=None)[0]
    return bool(np.abs(errors).max() <= AFFINE * np.ptp(positions, axis=0).max())
