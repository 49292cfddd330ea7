"""Columns of a delimited text file (CSV). Encoding, delimiter and decimal mark are detected and logged; a cell that is
no number is told by its line and column. Numbers are rounded correctly: a written float comes back to the bit.
"""

from __future__ import annotations

import codecs
import csv
import io
import logging
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import SoftkinError
from softkin.core.samples import Array

logger = logging.getLogger("softkin")

DELIMITERS = {",": "comma", ";": "semicolon", "\t": "tab", "|": "bar"}
SAMPLE_BYTES = 1 << 18
SAMPLE_ROWS = 200
#: What arrow takes for a finite number, with the decimal mark left open.
NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?", re.ASCII)
THOUSANDS = re.compile(r"[+-]?\d{1,3}([.,' ]\d{3})+([.,]\d+)?", re.ASCII)
_ENCODINGS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}


@dataclass(frozen=True, slots=True)
class DelimitedText:
    """A text file with a header: how it is written, and the `names` of its columns in their order."""

    path: Path
    encoding: str
    delimiter: str
    lines_above: int
    names: tuple[str, ...]

    def read(self, numbers: Sequence[int], others: Sequence[int]) -> tuple[Array, list[NDArray[Any]]]:
        """Columns by their places, each once: `numbers` as (n_rows, n_numbers), each of `others` as text (n_rows,).

        Raises:
            SoftkinError: a cell of `numbers` is no finite number, or a row has more or fewer values than the header.
        """
        import pyarrow as pa

        complaint = ""
        for mark, name in ((".", "points"), (",", "commas")):
            try:
                table = self._parse(numbers, others, mark)
            except pa.ArrowException as error:
                complaint = str(error)
                continue
            values = np.empty((table.num_rows, len(numbers)))
            for place, number in enumerate(numbers):
                values[:, place] = table.column(f"c{number}").to_numpy()
            texts = [table.column(f"c{other}").to_numpy().astype(object) for other in others]
            if not np.isfinite(values).all():
                break
            delimiter = DELIMITERS.get(self.delimiter, repr(self.delimiter))
            logger.info("read as %s, columns split by %s, decimal %s", self.encoding, delimiter, name)
            if mark == "," and all(THOUSANDS.fullmatch(cell) for cell in self._first_cells(numbers) if "," in cell):
                logger.warning(
                    "%s: numbers such as 1,234 were read as decimal commas (1.234)\n"
                    "  mend: if they are thousands, save the file without separators of thousands",
                    self.path,
                )
            return values, texts
        raise SoftkinError(self._complaint(numbers) or f"{complaint}\n  mend: save the file as CSV anew")

    def place(self, row: int) -> str:
        """Where row `row` (from 0, without the header) stands in the file."""
        with self._open() as lines:
            return f"line {next(islice(self._rows(lines), row + 1, None))[0]}"

    def _parse(self, numbers: Sequence[int], others: Sequence[int], mark: str) -> Any:
        import pyarrow as pa
        from pyarrow import csv as arrow

        chosen = {f"c{place}": pa.float64() for place in numbers} | {f"c{place}": pa.string() for place in others}
        return arrow.read_csv(
            self.path,
            arrow.ReadOptions(
                use_threads=False,
                encoding="utf-16" if self.encoding == "utf-16" else "utf8",
                column_names=[f"c{place}" for place in range(len(self.names))],
                skip_rows=self.lines_above,
                skip_rows_after_names=1,
            ),
            # Only a header ever has line breaks within quotes; looking out for them costs time.
            arrow.ParseOptions(delimiter=self.delimiter, newlines_in_values="\n" in "".join(self.names)),
            arrow.ConvertOptions(column_types=chosen, include_columns=list(chosen), null_values=[], decimal_point=mark),
        )

    def _open(self) -> io.TextIOWrapper:
        return open(self.path, encoding=self.encoding, newline="")

    def _rows(self, lines: Iterator[str]) -> Iterator[tuple[int, list[str]]]:
        """(line on which it ends, cells) of each row that is not blank, the header first."""
        for _ in range(self.lines_above):
            next(lines)
        return ((self.lines_above + line, row) for line, row in _rows(lines, self.delimiter))

    def _first_cells(self, numbers: Sequence[int]) -> list[str]:
        with self._open() as lines:
            rows = [row for _, row in islice(self._rows(lines), 1, SAMPLE_ROWS) if len(row) == len(self.names)]
        return [row[place].strip(" \t") for row in rows for place in numbers]

    def _complaint(self, numbers: Sequence[int]) -> str:
        """The first bad row, told in full, and how many follow; empty when none is found."""
        cells = self._first_cells(numbers)
        mark = "," if sum("," in cell for cell in cells) > sum("." in cell for cell in cells) else "."
        with self._open() as lines:
            rows = islice(self._rows(lines), 1, None)
            bad = [(line, problem) for line, row in rows if (problem := self._problem(row, numbers, mark))]
        if not bad:
            return ""
        what, mend = bad[0][1]
        more = f" (and {len(bad) - 1} more rows have such problems, the last is line {bad[-1][0]})" if bad[1:] else ""
        return f"line {bad[0][0]}, {what}{more}\n  mend: {mend}"

    def _problem(self, row: list[str], numbers: Sequence[int], mark: str) -> tuple[str, str] | None:
        """What is wrong with a row and how to mend it, or None."""
        if len(row) != len(self.names):
            return (
                f"all columns: {len(row)} values, but the header names {len(self.names)} columns",
                f"give each row one value per column, split by '{self.delimiter}'; where numbers have decimal commas, "
                "split columns by semicolons; or name the character that splits them in `delimiter` of the entry",
            )
        cells = [row[place] for place in numbers]
        if _are_plainly_numbers(cells, mark):
            return None
        for place in numbers:
            cell = row[place].strip(" \t")
            if NUMBER.fullmatch(cell) and ({".": ",", ",": "."}[mark] not in cell):
                if math.isfinite(float(cell.replace(",", "."))):
                    continue
                problem = f"too large a number: '{cell}'", "correct the value or delete the row"
            elif not cell:
                problem = "no value", "fill the cell or delete the row"
            elif cell.lower().lstrip("+-") in ("nan", "na", "n/a", "null", "none", "inf", "infinity"):
                problem = f"no finite number: '{cell}'", "fill the cell or delete the row"
            elif THOUSANDS.fullmatch(cell) and not NUMBER.fullmatch(cell):
                problem = f"a separator of thousands: '{cell}'", "save the numbers without separators of thousands"
            elif NUMBER.fullmatch(cell):
                others = {".": "points", ",": "commas"}[mark]
                problem = (
                    f"'{cell}', where other numbers have decimal {others}",
                    "write all numbers with one decimal mark",
                )
            else:
                problem = f"no number: '{cell[:40]}'", "correct the cell, or leave the column out of the entry"
            return f"column '{self.names[place]}': {problem[0]}", problem[1]
        return None


def _are_plainly_numbers(cells: Sequence[str], mark: str) -> bool:
    """A quick yes; a no means that one must look closer."""
    text = "".join(cells)
    if not text.isascii() or "_" in text or {".": ",", ",": "."}[mark] in text:
        return False
    try:
        return all(math.isfinite(float(cell.replace(",", "."))) for cell in cells)
    except ValueError:
        return False


def open_text(path: Path, delimiter: str | None = None) -> DelimitedText:
    """Detect how the text file `path` is written, from its beginning; `delimiter` overrides detection.

    Raises:
        SoftkinError: empty, no text, no header, or one column only.
    """
    with open(path, "rb") as file:
        start = file.read(SAMPLE_BYTES)
        is_whole = not file.read(1)
    encoding = next((name for mark, name in _ENCODINGS.items() if start.startswith(mark)), "utf-8")
    try:
        text = codecs.getincrementaldecoder(encoding)().decode(start, final=is_whole)
    except UnicodeDecodeError as error:
        line = start[: error.start].count(b"\n") + 1
        raise SoftkinError(
            f"line {line}: not {encoding}: {error.reason} (byte {start[error.start]:#04x})\n"
            "  mend: save the file as 'CSV UTF-8', or write its header in plain letters"
        ) from error
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise SoftkinError(
            f"line {line}: holds zero bytes: UTF-16 without its mark, or no text\n  mend: save the file as 'CSV UTF-8'"
        )
    if not text.strip():
        raise SoftkinError("the file is empty\n  mend: export it again, with a header and rows of numbers")

    lines = io.StringIO(text, newline="").readlines()
    if not is_whole:
        lines.pop()  # cut off in the middle
    above = 0
    while above < len(lines) and (not lines[above].strip() or lines[above].startswith("sep=")):
        if lines[above][4:5] in DELIMITERS:  # Excel's own note of it
            delimiter = delimiter or lines[above][4]
        above += 1
    sample = lines[above : above + SAMPLE_ROWS]
    if not sample:
        raise SoftkinError(
            "no rows in the first 256 kB\n  mend: save the table as CSV, one row per line, under a header"
        )
    tried = repr(delimiter) if delimiter else ", ".join(DELIMITERS.values())
    delimiter = delimiter or max(DELIMITERS, key=lambda candidate: _fit(sample, candidate))
    names = tuple(name.strip() for name in next(_rows(iter(sample), delimiter))[1])
    if len(names) < 2:
        raise SoftkinError(
            f"line {above + 1}: one column only, '{''.join(names)[:60]}'; columns are split by none of {tried}\n"
            "  mend: save the file as CSV, or name the character that splits columns in `delimiter` of the entry"
        )
    if all(NUMBER.fullmatch(name) or not name for name in names):
        raise SoftkinError(
            f"line {above + 1}: no header: the first row holds numbers only ('{delimiter.join(names)[:60]}')\n"
            "  mend: write a row with the names of the columns above it"
        )
    return DelimitedText(path, encoding, delimiter, above, names)


def _fit(sample: list[str], delimiter: str) -> tuple[bool, int]:
    """How well a delimiter splits the first rows: into equally many cells at all, and into how many."""
    counts = [len(row) for _, row in _rows(iter(sample), delimiter)]
    return len(set(counts)) == 1 and counts[0] > 1, counts[0]


def _rows(lines: Iterator[str], delimiter: str) -> Iterator[tuple[int, list[str]]]:
    """(line on which it ends, cells) of each row that is not blank."""
    reader = csv.reader(lines, delimiter=delimiter)
    try:
        for row in reader:
            if row:
                yield reader.line_num, row
    except (csv.Error, UnicodeDecodeError) as error:
        raise SoftkinError(
            f"line {reader.line_num + 1}: not readable: {error}\n  mend: save the file as 'CSV UTF-8'"
        ) from error
