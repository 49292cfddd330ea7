"""How a text file is written: encoding, delimiter, what stands above its rows, and the names of its columns.

Above the rows may stand lines of comment (`#`, `%`, `//`), a preamble of other shape, a header of one row or two, and a
row of units. All of it is read off the first 256 kB.
"""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from softkin.core.errors import DataError
from softkin.data.readers.header_rows import (
    COMMENTS,
    are_units,
    has_more_names,
    holds_values,
    is_number,
    joined_names,
    units_of,
)
from softkin.data.readers.text_encoding import decoded

BLANKS = " "
DELIMITERS = {",": "comma", ";": "semicolon", "\t": "tab", "|": "bar", BLANKS: "blanks"}
SAMPLE_BYTES = 1 << 18
SAMPLE_ROWS = 200
#: Of the rows below a header that is not on the first line, this share has as many cells as it.
SAME_SHAPE = 0.9
#: A header stands below at most so many rows of other things.
MOST_ABOVE = 30
#: A whole number, and one that nobody writes: it is what stands before or behind a decimal mark.
_WHOLE = re.compile(r"[+-]?\d+")
_NO_WHOLE = re.compile(r"-0|[+-]?0\d+")


@dataclass(frozen=True, slots=True)
class TextLayout:
    """How a text file is written: `lines_above` its header and `header_rows` that hold names and units (0 where there
    is no header), the `names` of its columns in their order, and the `units` that a row below them tells.
    """

    encoding: str
    delimiter: str
    lines_above: int
    names: tuple[str, ...]
    header_rows: int = 1
    units: tuple[str, ...] = ()


def layout_of(
    start: bytes, is_whole: bool, delimiter: str | None = None, header: str | int | None = None
) -> TextLayout:
    """The layout of a text file whose first bytes are `start`, all of it where `is_whole`.

    Parameters:
        delimiter: overrides detection.
        header: the line (from 1) of the names, or "none"; None: it is detected.

    Raises:
        DataError: empty, no text, no header, or one column only.
    """
    text, encoding = decoded(start, is_whole)
    lines = io.StringIO(text, newline="").readlines()
    if not is_whole:
        lines.pop()  # cut off in the middle
    above, noted = _first_row(lines)
    if isinstance(header, int):
        above = header - 1
    delimiter = delimiter or noted
    sample = lines[above : above + SAMPLE_ROWS]
    if not sample:
        raise DataError(
            "no rows in the first 256 kB", fix="save the table as CSV, one row per line, under a row with the names"
        )
    tried = repr(delimiter) if delimiter else ", ".join(DELIMITERS.values())
    delimiter = delimiter or _best(sample)
    rows = list(rows_of(iter(sample), delimiter))
    if not any(len(row) > 1 for _, row in rows[:1]) and _shape(rows)[1] < 2:
        raise DataError(
            f"one column only, '{''.join(rows[0][1])[:60]}'; columns are split by none of {tried}",
            where=f"line {above + 1}",
            fix="save the file as CSV, or write the character that separates columns as `delimiter` of the entry",
        )
    if header is None:
        layout = _detected(lines[:above], rows, encoding, delimiter, above)
    elif isinstance(header, int):
        layout = _below(rows, 0, TextLayout(encoding, delimiter, above, ()))
    else:
        _check_marks([row for _, row in rows], delimiter, above)
        layout = TextLayout(encoding, delimiter, above, _numbered(_shape(rows)[1]), 0)
    if is_whole and len(list(rows_of(iter(lines[layout.lines_above :]), delimiter))) <= layout.header_rows:
        raise DataError("a header, but no row of numbers", fix="export the file again")
    return layout


def rows_of(lines: Iterator[str], delimiter: str) -> Iterator[tuple[int, list[str]]]:
    """(line on which it ends, cells) of each row that is not blank."""
    if delimiter == BLANKS:
        lines = (" ".join(line.split()) + "\n" for line in lines)
    reader = csv.reader(lines, delimiter=delimiter)
    try:
        for row in reader:
            if row:
                yield reader.line_num, row
    except (csv.Error, UnicodeDecodeError) as error:
        raise DataError(
            f"not readable: {error}", where=f"line {reader.line_num + 1}", fix="save the file as 'CSV UTF-8'"
        ) from error


def _first_row(lines: Sequence[str]) -> tuple[int, str | None]:
    """How many lines above the first row are blank or comments, and the delimiter that Excel noted there."""
    above, noted = 0, None
    while above < len(lines) and (
        not lines[above].strip() or lines[above].startswith("sep=") or lines[above].lstrip().startswith(COMMENTS)
    ):
        if lines[above].startswith("sep=") and lines[above][4:5] in DELIMITERS:
            noted = noted or lines[above][4]
        above += 1
    return above, noted


def _check_marks(rows: Sequence[Sequence[str]], delimiter: str, above: int) -> None:
    """Rows without header whose columns and decimals are both marked by commas: nothing else tells them apart."""
    cells = [cell.strip() for row in rows for cell in row]
    if delimiter == "," and all(map(_WHOLE.fullmatch, cells)) and any(map(_NO_WHOLE.fullmatch, cells)):
        raise DataError(
            "commas split the columns and are decimal marks, too: there are parts of numbers such as "
            f"{next(cell for cell in cells if _NO_WHOLE.fullmatch(cell))}",
            where=f"line {above + 1}",
            fix="save the file with columns split by semicolons, or with decimal points",
        )


def _best(sample: list[str]) -> str:
    """The delimiter that splits the first rows best; blanks where no other does."""
    fits = {delimiter: _fit(sample, delimiter) for delimiter in DELIMITERS}
    blanks = fits.pop(BLANKS)
    best = max(fits, key=lambda delimiter: fits[delimiter])
    splits_better = not any(fits[best][:2]) or (blanks[2] > fits[best][2] and not fits[best][1])
    return BLANKS if blanks > fits[best] and splits_better and any(blanks[:2]) else best


def _fit(sample: list[str], delimiter: str) -> tuple[bool, bool, float, int]:
    """How well a delimiter splits the first rows: into equally many cells at all, below a header, into which share of
    numbers, and into how many.
    """
    rows = list(rows_of(iter(sample), delimiter))
    first, n_cells = _shape(rows)
    counts = {len(row) for _, row in rows}
    last = rows[-1][1] if rows else []
    share = sum(map(is_number, last)) / len(last) if len(last) > 1 else 0.0
    return len(counts) == 1 and n_cells > 1, _is_header(rows, first), share, n_cells


def _shape(rows: Sequence[tuple[int, list[str]]]) -> tuple[int, int]:
    """The first row that has as many cells as most have, and how many."""
    counts = [len(row) for _, row in rows]
    if not counts:
        return 0, 0
    n_cells = Counter(counts).most_common(1)[0][0]
    return counts.index(n_cells), n_cells


def _is_header(rows: Sequence[tuple[int, list[str]]], first: int) -> bool:
    """Whether row `first` holds names without any number, and those below as many cells."""
    below, cells = rows[first + 1 :], rows[first][1] if rows else []
    if len(cells) < 2 or not below or any(is_number(cell) for cell in cells) or not all(c.strip() for c in cells[1:]):
        return False
    alike = sum(len(row) == len(cells) for _, row in below)
    return alike >= SAME_SHAPE * len(below) and any(is_number(cell) for cell in below[-1][1])


def _detected(
    comments: Sequence[str], rows: Sequence[tuple[int, list[str]]], encoding: str, delimiter: str, above: int
) -> TextLayout:
    """The layout where nobody says in which line the names are."""
    first, n_cells = _shape(rows)
    first = first if len(rows[0][1]) != n_cells and _is_header(rows, first) else _below_padded(rows)
    layout = TextLayout(encoding, delimiter, above, ())
    cells = [cell.strip() for cell in rows[first][1]]
    names = None
    if any(map(is_number, cells)):
        names = next((names for line in reversed(comments) if (names := _commented(line, delimiter, len(cells)))), None)
    are_numbers = all(is_number(cell) or not cell for cell in cells)
    if names is None and not are_numbers and not holds_values(cells):
        return _below(
            rows, first + (first + 1 < len(rows) and has_more_names([row for _, row in rows[first:]])), layout
        )
    if names is None:
        raise DataError(
            f"no header: the first row holds numbers{' only' * are_numbers} ('{delimiter.join(cells)[:60]}')",
            where=f"line {above + 1}",
            fix="write a row with the names of the columns above it, or header: none into the entry (make new-robot "
            "HEADER=none), which calls them c1, c2, ...",
        )
    return TextLayout(encoding, delimiter, above, names, 0)


def _below_padded(rows: Sequence[tuple[int, list[str]]]) -> int:
    """The row of the header where rows above it are filled up with empty cells, as Excel does it; 0 otherwise."""
    if all(cell.strip() for cell in rows[0][1][1:]):
        return 0
    for row in range(1, min(len(rows), MOST_ABOVE)):
        if _is_header(rows, row) and not are_units(rows[row][1]):
            return row
    return 0


def _below(rows: Sequence[tuple[int, list[str]]], first: int, layout: TextLayout) -> TextLayout:
    """The layout of a file whose header is row `first` of `rows`."""
    line, cells = rows[first]
    above = layout.lines_above + line - 1 - sum(cell.count("\n") for cell in cells)
    names = joined_names(rows[first - 1][1] if first else (), cells)
    below = [row for _, row in rows[first + 1 : first + 4]]
    if below and not below[0][-1].strip() and len(below[0]) == len(names) + 1:
        names = (*names, "")  # a delimiter at the end of each row, but not of the header
    units = units_of(below, len(names))
    where = above if first else layout.lines_above
    return TextLayout(layout.encoding, layout.delimiter, where, names, 1 + bool(units), units)


def _commented(line: str, delimiter: str, n_cells: int) -> tuple[str, ...] | None:
    """Names in a line of comment, as many as there are columns."""
    text = line.strip().lstrip("".join(COMMENTS)).strip()
    for candidate in dict.fromkeys((delimiter, *DELIMITERS)):
        for _, cells in rows_of(iter([text]), candidate):
            if len(cells) == n_cells and not any(is_number(cell) for cell in cells):
                return tuple(cell.strip() for cell in cells)
    return None


def _numbered(n_cells: int) -> tuple[str, ...]:
    return tuple(f"c{place + 1}" for place in range(n_cells))
