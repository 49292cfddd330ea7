"""A table of the page: columns that sort, some that filter, cells that carry marks, and a link to its CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from urllib.parse import quote

from softkin.core.escaping import csv_text
from softkin.core.units import MM
from softkin.reporting.page.marks import Mark, merged
from softkin.reporting.tables.numbers import number_text, share_text


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
    """`sentence` stands above the table and says what it is, `remarks` below it; `file` is the path of its CSV beside
    the page, empty for a table that is only on the page.
    """

    name: str
    title: str
    sentence: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[Cell]]
    file: str = ""
    remarks: Sequence[str] = ()

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

    @property
    def link(self) -> str:
        """Address of the CSV: the file beside the page, or a data URI of what the table shows."""
        if self.file:
            return self.file
        stream = io.StringIO()
        writer = csv.writer(stream)
        writer.writerow(csv_text(column.title) for column in self.columns)
        writer.writerows([csv_text(cell.text) for cell in row] for row in self.rows)
        return "data:text/csv;charset=utf-8," + quote(stream.getvalue())


def number(value: float | None) -> Cell:
    """A number in the format of every table."""
    return Cell(number_text(value))


def share(value: float | None) -> Cell:
    """'91.4 %'."""
    return Cell(share_text(value))


def number_columns(*titles: str, unit: str = MM) -> list[Column]:
    """Columns of numbers; a title may hold `{unit}`."""
    return [Column(title.format(unit=unit), is_number=True) for title in titles]


def filtered_columns(*titles: str) -> list[Column]:
    """Columns with a menu."""
    return [Column(title, filtered=True) for title in titles]
