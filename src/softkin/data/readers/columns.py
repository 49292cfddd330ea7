"""Choose the columns of a robot's own table that are commands and positions, as its entry says, and check them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from softkin.core.errors import DataError
from softkin.core.units import LENGTHS

MAX_COMMANDS = 256
#: Of a dataset's description: columns that are not used, and those of them that are an orientation.
UNUSED, ORIENTATION = "unused_columns", "orientation_columns"
#: From more on it is said what they cost.
MANY_COMMANDS = 64
#: Words of a column's name that say an orientation.
ORIENTATION_WORDS = "roll pitch yaw rpy quaternion quat rotation rot orientation euler rotvec rodrigues"
_ORIENTATION = frozenset([*ORIENTATION_WORDS.split(), "qx", "qy", "qz", "qw"])
#: Letters that stand alone, capitals behind small letters (`tipX`), and what people write in one word: `px`, `xpos`.
_AXIS = re.compile(
    r"(?<![A-Za-z])[xyz](?![A-Za-z])|(?<![A-Z])[XYZ](?![A-Za-z])"
    r"|(?:(?<=\b[pP])|(?<=\b[pP]os)|(?<=\b[tT]ip))[xyz](?![A-Za-z])|(?<![A-Za-z])[xyz](?=([pP]os|[tT]ip|mm|cm)\b)"
)
_UNIT = re.compile(
    r"(?:[\[(_ ./]|(?<=^[xyzXYZ])(?=mm|cm))"
    r"(mm|cm|m|in|px|pixels?|inch(?:es)?|(?:milli|centi|micro)?met(?:er|re)s?|microns?|[uµμnkd]m|f(?:oo|ee)?t)[\])]?$"
)


def axis_of(name: str) -> tuple[str, str] | None:
    """The marker and the axis that a column's name tells: the rest of the name without its unit, and x, y or z. None
    where it tells no axis, or several.

    >>> axis_of("m2_x_mm")
    ('m2_', 'x')
    """
    name = _UNIT.sub("", name)
    axes = list(_AXIS.finditer(name))
    if len(axes) != 1:
        return None
    return name[: axes[0].start()] + name[axes[0].end() :], axes[0].group().lower()


def family_of(name: str, by_unit: bool = True) -> tuple[str, str] | None:
    """As `axis_of`, but axes in small letters and in capitals are told apart, since `X_1` and `y_1` are not of one
    marker; and with `by_unit` markers in other units: `x` and `x_m`.

    >>> family_of("X_1"), family_of("x_m")
    (('_1 X', 'x'), (' m', 'x'))
    """
    axis = axis_of(name)
    if axis is None:
        return None
    found = _AXIS.search(_UNIT.sub("", name))
    capital = "X" * (found is not None and found.group().isupper())
    return f"{axis[0]} {capital}{(unit_of(name) or '') * by_unit}", axis[1]


def unit_of(name: str) -> str | None:
    """The unit that a column's name ends with, as in `x_mm` or `x [inch]`, as entries write it; None without one."""
    unit = _UNIT.search(name)
    return LENGTHS.get(unit.group(1)) or unit.group(1) if unit else None


def orientations(names: Sequence[str]) -> list[str]:
    """The columns that are an orientation by their names: quaternions, roll, pitch and yaw, rotations.

    >>> orientations(["tip_x", "tip_qw", "Rotation Y", "u1"])
    ['tip_qw', 'Rotation Y']
    """
    return [name for name in names if set(re.findall("[a-z]+", name.lower())) & _ORIENTATION]


def choose(names: Sequence[str], wanted: str | Sequence[str], key: str) -> list[int]:
    """Places of the columns that `key` of the entry names: a list of names, or all that a pattern matches, in the
    file's order.

    Raises:
        DataError: no such column, or several of that name.
    """
    if isinstance(wanted, str) and wanted not in names:
        try:
            matching = [name for name in names if re.fullmatch(wanted, name)]
        except re.error as error:
            raise DataError(
                f"'{wanted}' is no pattern: {error}", where=f"`{key}`", fix="write a list of columns"
            ) from error
        if not matching:
            raise DataError(
                f"the pattern '{wanted}' matches no whole name of a column",
                where=f"`{key}`",
                fix=f"name some of the columns {_listed(names)}",
            )
        wanted = matching
    wanted = [wanted] if isinstance(wanted, str) else [str(name).strip() for name in wanted]
    counts = Counter(names)
    for name in wanted:
        if name not in counts:
            raise DataError(f"no column '{name}'", where=f"`{key}`", fix=f"name some of the columns {_listed(names)}")
        if counts[name] > 1:
            places = [str(place + 1) for place, other in enumerate(names) if other == name]
            raise DataError(
                f"{counts[name]} columns are named '{name}' (columns {', '.join(places)})",
                where=f"`{key}`",
                fix="give each its own name, or delete the copies",
            )
    return [list(names).index(name) for name in wanted]


def check(commands: Sequence[str], coordinates: Sequence[str], dimensions: int, source: Mapping[str, Any]) -> None:
    """Check the chosen names: each once, as many as the entry says, `dimensions` coordinates marker by marker.

    Raises:
        DataError: names the key and the columns.
    """
    twice = [name for name, count in Counter([*commands, *coordinates]).items() if count > 1]
    if twice:
        raise DataError(f"'{twice[0]}' is chosen twice", where="`commands`, `positions`", fix="name each column once")
    if len(commands) > MAX_COMMANDS:
        raise DataError(
            f"{len(commands)} columns, but at most {MAX_COMMANDS} are possible",
            where="`commands`",
            fix="write a list of the columns of commands alone",
        )
    if len(coordinates) % dimensions:
        raise DataError(
            f"{len(coordinates)} columns ({_listed(coordinates)}), but {dimensions} per marker",
            where="`positions`",
            fix="name all coordinates of each marker; for a planar robot add dimensions: 2",
        )
    _check_order(coordinates, dimensions)
    for key, number in (("n_commands", len(commands)), ("n_markers", len(coordinates) // dimensions)):
        if source.get(key, number) != number:
            raise DataError(
                f"{source[key]}, but the columns of the entry make it {number}",
                where=f"`{key}`",
                fix=f"correct `{key}`, or `commands` and `positions` of the entry",
            )


def marker_by_marker(coordinates: Sequence[str]) -> list[str]:
    """The names, those of one marker together, x before y before z; the markers keep their order."""
    named = {name: axis_of(name) or (name, "") for name in coordinates}
    markers = list(dict.fromkeys(marker for marker, _ in named.values()))
    return sorted(coordinates, key=lambda name: (markers.index(named[name][0]), named[name][1]))


def _check_order(coordinates: Sequence[str], dimensions: int) -> None:
    """Check that each marker has each axis once, where the names tell the axes."""
    axes = [axis[1] for name in coordinates if (axis := axis_of(name))]
    if len(axes) < len(coordinates) or len(set(axes)) == 1:
        return
    if len(set(axes)) != dimensions:
        raise DataError(
            f"the columns name the axes {', '.join(sorted(set(axes)))}, but `dimensions` is {dimensions}",
            where="`positions`",
            fix=f"write dimensions: {len(set(axes))}, or name all coordinates of each marker",
        )
    for first in range(0, len(axes), dimensions):
        if len(set(axes[first : first + dimensions])) < dimensions:
            raise DataError(
                f"{', '.join(coordinates[first : first + dimensions])} would be one marker",
                where="`positions`",
                fix=f"list them marker by marker, positions: [{', '.join(marker_by_marker(coordinates))}]",
            )


def _listed(names: Sequence[str]) -> str:
    shown = ", ".join(names[:40])
    return shown + (f" and {len(names) - 40} more" if len(names) > 40 else "")
