"""The bad rows of a delimited text file: where they stand, what is wrong with the first and how to fix it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from softkin.core.errors import DataError

#: What arrow takes for a finite number, with the decimal mark left open.
NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?", re.ASCII)
THOUSANDS = re.compile(r"[+-]?\d{1,3}([.,' ]\d{3})+([.,]\d+)?", re.ASCII)
_OTHER_MARK = {".": ",", ",": "."}
_MARKS = {".": "points", ",": "commas"}
#: Cells of numbers that say that there is none.
MISSING = (
    *("", "nan", "NaN", "NAN", "Nan", "na", "NA", "n/a", "N/A", "null", "NULL", "Null", "None", "none", "<NA>", "NaT"),
    *("-nan", "-NaN", "+nan", "+NaN", "nan(ind)", "-nan(ind)", "#N/A", "#NV", "-", "--", "---", "?"),
)
#: Bad rows are listed up to this many.
SHOWN = 10
FIX_MISSING = "fill the cell or delete the row, or write missing: drop_rows into the entry"
_INFINITE = ("inf", "infinity")


@dataclass(frozen=True, slots=True)
class Layout:
    """How rows should look: `names` of all columns, places of those that hold `numbers`, and in words the delimiter;
    `mark` is the decimal mark of most numbers; with `gaps` cells of numbers may be `MISSING`.
    """

    names: Sequence[str]
    numbers: Sequence[int]
    delimiter: str
    mark: str
    gaps: bool = False


@dataclass(frozen=True, slots=True)
class _Problem:
    what: str
    fix: str
    column: str | None = None


def first_bad_row(rows: Iterable[tuple[int, list[str]]], layout: Layout) -> DataError | None:
    """The error of the first bad one of the `rows` (line, cells), with the lines of all; None if all are good."""
    bad = [(line, problem) for line, row in rows if (problem := _problem(row, layout))]
    if not bad:
        return None
    line, problem = bad[0]
    count = f" ({listed('line', [line for line, _ in bad])})" if bad[1:] else ""
    column = "" if problem.column is None else f", column '{problem.column}'"
    return DataError(problem.what + count, where=f"line {line}{column}", fix=problem.fix)


def listed(what: str, places: Sequence[int]) -> str:
    """How many bad rows there are, and where the first ten are: `what` a place is, and its numbers."""
    shown = ", ".join(map(str, places[:SHOWN]))
    more = f" and {len(places) - SHOWN} more, the last {places[-1]}" if len(places) > SHOWN else ""
    return f"rows with such problems: {len(places)}, {what}s {shown}{more}"


def _problem(row: Sequence[str], layout: Layout) -> _Problem | None:
    """What is wrong with a row, or None."""
    if len(row) != len(layout.names):
        return _Problem(
            f"{len(row)} value{'s' * (len(row) != 1)}, but the header names {len(layout.names)} columns",
            f"write one value per column, separated by {layout.delimiter}; where numbers have decimal commas, separate "
            "columns by semicolons; or write the character that separates them as `delimiter` of the entry; "
            "delete a line that is no row",
        )
    if _are_plainly_numbers([row[place] for place in layout.numbers], layout.mark):
        return None
    for place in layout.numbers:
        if layout.gaps and row[place] in MISSING:
            continue
        problem = _problem_of_cell(row[place].strip(" \t"), layout.mark)
        if problem:
            return _Problem(*problem, layout.names[place])
    return None


def _problem_of_cell(cell: str, mark: str) -> tuple[str, str] | None:
    """What is wrong with a cell that should hold a finite number, and the fix; or None."""
    if NUMBER.fullmatch(cell) and _OTHER_MARK[mark] not in cell:
        if math.isfinite(float(cell.replace(",", "."))):
            return None
        return f"too large a number: '{cell[:40]}'", "correct the value or delete the row"
    if not cell:
        return "no value", FIX_MISSING
    if cell in MISSING:
        return f"no finite number: '{cell}'", FIX_MISSING
    if cell.lower().lstrip("+-") in _INFINITE:
        return f"no finite number: '{cell}'", "correct the value or delete the row"
    if NUMBER.fullmatch(cell):
        return (
            f"'{cell[:40]}', where other numbers have decimal {_MARKS[mark]}",
            "write all numbers with one decimal mark",
        )
    if THOUSANDS.fullmatch(cell):
        return f"a separator of thousands: '{cell[:40]}'", "write numbers without separators of thousands"
    return f"no number: '{cell[:40]}'", "correct the cell, or leave the column out of the entry"


def _are_plainly_numbers(cells: Sequence[str], mark: str) -> bool:
    """True where a quick look shows that all `cells` are finite numbers; False where a closer look is needed."""
    text = "".join(cells)
    if not text.isascii() or "_" in text or _OTHER_MARK[mark] in text:
        return False
    try:
        return all(math.isfinite(float(cell.replace(",", "."))) for cell in cells)
    except ValueError:
        return False
