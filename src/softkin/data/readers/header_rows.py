"""Rows above the numbers of a text file that tell about its columns: names in one row or two, units, comments."""

from __future__ import annotations

import re
from collections.abc import Sequence

from softkin.data.readers.bad_rows import MISSING, NUMBER

COMMENTS = ("#", "%", "//")
#: What a cell of a row of units holds, perhaps in brackets.
UNIT = re.compile(
    r"[\[(]?(|-|1|%|[munkµ]?m|cm|in|inch|inches|ft|feet|microns?|px|pixels?|(milli|centi)?met(er|re)s?"
    r"|[mk]?bar|[kM]?Pa|psi|[mk]?N|N?[ .*]?m?Nm"
    r"|[mk]?V|volts?|m?A|[munµ]?s|sec|seconds?|[mk]?Hz|deg|degrees?|°|rad|radians?|°?C|K|steps?|counts?|ticks?|rpm|k?g"
    r"|[muµ]?[lL]|(m|cm|mm|rad|deg)/s(\^?2|²)?|[muµ]?[lL]/(min|s)|bool|a\.?u\.?|none)[\])]?"
)
#: A number that may be a name: of a chamber, a motor.
_COUNT = re.compile(r"\d{1,2}")


def is_number(cell: str) -> bool:
    """Whether a cell holds a number, with a decimal point or comma."""
    return bool(NUMBER.fullmatch(cell.strip()))


def are_units(cells: Sequence[str]) -> bool:
    """Whether all cells of a row are units, or empty."""
    return all(UNIT.fullmatch(cell.strip()) for cell in cells)


def units_of(below: Sequence[Sequence[str]], n_cells: int) -> tuple[str, ...]:
    """The row of units at the beginning of the rows `below` a header of `n_cells`; empty where there is none."""
    if len(below) < 2 or len(below[0]) != n_cells or not any(is_number(cell) for cell in below[1]):
        return ()
    cells = tuple(cell.strip() for cell in below[0])
    if not any(cells) or any(is_number(cell) and cell != "1" for cell in cells):
        return ()
    is_row = are_units(cells) and sum(map(is_number, cells)) < sum(map(bool, cells))
    return tuple(cell.strip("[]()") for cell in cells) if is_row else ()


def holds_values(cells: Sequence[str]) -> bool:
    """Whether a row that is not all numbers is a row of numbers and texts all the same, and no header: at least half of
    what it holds are numbers, and not all of them could number columns.
    """
    filled = [cell.strip() for cell in cells if cell.strip()]
    numbers = [cell for cell in filled if is_number(cell)]
    return 2 * len(numbers) >= len(filled) and not all(map(_COUNT.fullmatch, numbers))


def has_more_names(rows: Sequence[Sequence[str]]) -> bool:
    """Whether names stand in the second of these rows, too, such as `tip, tip, tip` above `x, y, z`, since those of the
    first do not tell columns apart; numbers below.
    """
    if len(rows) < 3 or not len(rows[0]) == len(rows[1]) == len(rows[2]):
        return False
    top, names, values = ([cell.strip() for cell in row] for row in rows[:3])
    filled = [cell for cell in names if cell]
    numbers = [cell for cell in filled if is_number(cell)]
    if (all(top[1:]) and len(set(top)) == len(top)) or are_units(names):
        return False
    if any(cell in MISSING for cell in filled) or len(numbers) == len(filled):
        return False
    if numbers and (all(top[1:]) or not all(map(_COUNT.fullmatch, numbers))):
        return False
    below = values if any(map(is_number, values)) or len(rows) < 4 else rows[3]
    return 2 * sum(map(is_number, below)) >= len(filled) and sum(map(is_number, below)) > len(numbers)


def joined_names(above: Sequence[str], names: Sequence[str]) -> tuple[str, ...]:
    """Names, each below that of its group where they would not tell columns apart; a group holds for the empty cells
    right of it.
    """
    own = tuple(cell.strip().strip('"') for cell in names)
    filled = [name for name in own if name]
    if len(above) != len(own) or (len(set(filled)) == len(filled) and not any(map(is_number, own))):
        return own
    groups, group = [], ""
    for cell in above:
        group = cell.strip() or group
        groups.append(group)
    return tuple(f"{group} {name}".strip() if name else name for group, name in zip(groups, own, strict=True))
