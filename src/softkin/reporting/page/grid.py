"""A table of the report: columns that sort, some that filter, cells that carry marks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from softkin.reporting.page.marks import Mark, merged
from softkin.reporting.tables.paper_layout import format_number

#: What stands where there is no number.
NOTHING = "–"


@dataclass(frozen=True, slots=True)
class Column:
    """`is_number` aligns it to the right and sorts it by value; `filtered` gives it a menu, set to `preset` at first.
    `is_wide` lets its text run over several lines.
    """

    title: str
    is_number: bool = False
    filtered: bool = False
    preset: str = ""
    is_wide: bool = False


@dataclass(frozen=True, slots=True)
class Cell:
    """Text, its marks, and how it looks: `verdict` is a class of the style sheet, such as `better`."""

    text: str
    marks: tuple[Mark, ...] = ()
    verdict: str = ""


@dataclass(frozen=True, slots=True)
class Grid:
    """`sentence` stands above the table and says what it is; `file` names the CSV that has everything in it."""

    name: str
    title: str
    sentence: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[Cell]]
    file: str = ""

    @property
    def menus(self) -> list[tuple[int, Column, list[str]]]:
        """(place, column, its values in order of appearance) of each filtered column with more than one value."""
        values = {
            place: list(dict.fromkeys(row[place].text for row in self.rows))
            for place, column in enumerate(self.columns)
            if column.filtered
        }
        return [(place, self.columns[place], texts) for place, texts in values.items() if len(texts) > 1]

    @property
    def notes(self) -> list[Mark]:
        """The marks in this table that need words, each once."""
        return [mark for mark in merged([cell.marks for row in self.rows for cell in row]) if mark.text]


def number(value: float | None, unit: str = "") -> Cell:
    """Three significant digits; a dash for what was not measured."""
    return Cell(number_text(value, unit))


def number_text(value: float | None, unit: str = "") -> str:
    """As `number`, without the cell."""
    if value is None or math.isnan(value):
        return NOTHING
    if math.isinf(value):
        return "infinite"
    return format_number(float(value)) + (f" {unit}" if unit else "")


def share(value: float | None) -> Cell:
    """'91.4 %'."""
    return Cell(share_text(value))


def share_text(value: float | None, digits: int = 1) -> str:
    """As `share`, without the cell."""
    return NOTHING if value is None or math.isnan(value) else f"{100 * value:.{digits}f} %"
