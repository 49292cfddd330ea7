"""Which columns of a robot's own table are commands and which are positions: chosen as its entry says, and checked."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from softkin.core.errors import SoftkinError

MAX_COMMANDS = 64
_AXIS = re.compile(r"(?<![A-Za-z])[xyz](?![A-Za-z])|(?<![A-Z])[XYZ](?![A-Za-z])")
_UNIT = re.compile(r"[\[(_ .](mm|cm|m|in)[\])]?$")


def axis_of(name: str) -> tuple[str, str] | None:
    """What a column's name says of a position: the rest of the name without its unit, and x, y or z. None where it says
    neither, or several.

    >>> axis_of("m2_x_mm")
    ('m2_', 'x')
    """
    name = _UNIT.sub("", name)
    found = list(_AXIS.finditer(name))
    if len(found) != 1:
        return None
    return name[: found[0].start()] + name[found[0].end() :], found[0].group().lower()


def unit_of(name: str) -> str | None:
    """The unit of length that a column's name ends with, as in `x_mm` or `x [mm]`."""
    found = _UNIT.search(name)
    return found.group(1) if found else None


def choose(names: Sequence[str], wanted: str | Sequence[str], key: str) -> list[int]:
    """Places of the columns that `key` of the entry wants: by name, or all that a pattern matches, in the file's order.

    Raises:
        SoftkinError: no such column, or several of that name.
    """
    if isinstance(wanted, str) and wanted not in names:
        try:
            matching = [name for name in names if re.fullmatch(wanted, name)]
        except re.error as error:
            raise SoftkinError(
                f"`{key}`: '{wanted}' is no pattern: {error}\n  mend: write a list of columns"
            ) from error
        if not matching:
            raise SoftkinError(
                f"`{key}`: the pattern '{wanted}' matches no column whole\n  mend: the columns are {_listed(names)}"
            )
        wanted = matching
    wanted = [wanted] if isinstance(wanted, str) else [str(name).strip() for name in wanted]
    counts = Counter(names)
    for name in wanted:
        if name not in counts:
            raise SoftkinError(f"`{key}`: no column '{name}'\n  mend: the columns are {_listed(names)}")
        if counts[name] > 1:
            places = [str(place + 1) for place, other in enumerate(names) if other == name]
            raise SoftkinError(
                f"`{key}`: {counts[name]} columns are named '{name}' (columns {', '.join(places)})\n"
                "  mend: give each its own name, or delete the copies"
            )
    return [list(names).index(name) for name in wanted]


def check(commands: Sequence[str], coordinates: Sequence[str], dimensions: int, source: Mapping[str, Any]) -> None:
    """Check the chosen names: each once, as many as the entry says, `dimensions` coordinates marker by marker.

    Raises:
        SoftkinError: names the key and the columns.
    """
    twice = [name for name, count in Counter([*commands, *coordinates]).items() if count > 1]
    if twice:
        raise SoftkinError(f"`commands`, `positions`: '{twice[0]}' is chosen twice\n  mend: name each column once")
    if len(commands) > MAX_COMMANDS:
        raise SoftkinError(f"`commands`: {len(commands)} columns, at most {MAX_COMMANDS}\n  mend: list the columns")
    if len(coordinates) % dimensions:
        raise SoftkinError(
            f"`positions`: {len(coordinates)} columns ({_listed(coordinates)}), but {dimensions} per marker\n"
            "  mend: name all coordinates of each marker; for a planar robot add `dimensions: 2`"
        )
    _check_order(coordinates, dimensions)
    for key, found in (("n_commands", len(commands)), ("n_markers", len(coordinates) // dimensions)):
        if source.get(key, found) != found:
            raise SoftkinError(
                f"`{key}` is {source[key]}, but the entry's columns make it {found}\n  mend: correct one"
            )


def marker_by_marker(coordinates: Sequence[str]) -> list[str]:
    """The names, each of one axis, with those of one marker together, x before y before z; markers as they came."""
    named = {name: axis_of(name) or (name, "") for name in coordinates}
    markers = list(dict.fromkeys(marker for marker, _ in named.values()))
    return sorted(coordinates, key=lambda name: (markers.index(named[name][0]), named[name][1]))


def _check_order(coordinates: Sequence[str], dimensions: int) -> None:
    """Where names tell the axes, each marker must have each of them once."""
    axes = [axis[1] for name in coordinates if (axis := axis_of(name))]
    if len(axes) < len(coordinates) or len(set(axes)) == 1:
        return
    if len(set(axes)) != dimensions:
        raise SoftkinError(
            f"`positions`: the columns name the axes {', '.join(sorted(set(axes)))}, but `dimensions` is {dimensions}\n"
            f"  mend: write dimensions: {len(set(axes))}, or name all coordinates of each marker"
        )
    for first in range(0, len(axes), dimensions):
        if len(set(axes[first : first + dimensions])) < dimensions:
            raise SoftkinError(
                f"`positions`: {', '.join(coordinates[first : first + dimensions])} would be one marker\n"
                f"  mend: list them marker by marker: positions: [{', '.join(marker_by_marker(coordinates))}]"
            )


def _listed(names: Sequence[str]) -> str:
    shown = ", ".join(names[:40])
    return shown + (f" and {len(names) - 40} more" if len(names) > 40 else "")
