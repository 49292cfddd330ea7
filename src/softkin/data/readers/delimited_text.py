"""Columns of a delimited text file (CSV). Encoding, delimiter and decimal mark are detected and logged. Numbers are
rounded correctly: a float that was written with all its digits comes back to the bit.
"""

from __future__ import annotations

import codecs
import csv
import io
import logging
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.data.readers.bad_rows import NUMBER, THOUSANDS, Layout, first_bad_row

logger = logging.getLogger("softkin")

DELIMITERS = {",": "comma", ";": "semicolon", "\t": "tab", "|": "bar"}
SAMPLE_BYTES = 1 << 18
SAMPLE_ROWS = 200
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
            DataError: a cell of `numbers` is no finite number, or a row has more or fewer values than the header.
        """
        import pyarrow as pa

        reason = ""
        for mark, name in ((".", "points"), (",", "commas")):
            try:
                table = self._parse(numbers, others, mark)
            except pa.ArrowException as error:
                reason = str(error)
                continue
            values = np.empty((table.num_rows, len(numbers)))
            for place, number in enumerate(numbers):
                values[:, place] = table.column(f"c{number}").to_numpy()
            texts = [table.column(f"c{other}").to_numpy().astype(object) for other in others]
            if not np.isfinite(values).all():
                break
            logger.info("read as %s, columns split by %s, decimal %s", self.encoding, self._delimiter_in_words(), name)
            if mark == "," and all(THOUSANDS.fullmatch(cell) for cell in self._first_cells(numbers) if "," in cell):
                remark = DataError(
                    "numbers such as 1,234 were read as decimal commas (1.234)",
                    where=self.path,
                    fix="if they are thousands, save the file without separators of thousands",
                )
                logger.warning("%s", remark)
            return values, texts
        raise self._first_bad_row(numbers) or DataError(
            f"not readable as CSV: {reason}", fix="save the file as CSV anew"
        )

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

    def _first_bad_row(self, numbers: Sequence[int]) -> DataError | None:
        cells = self._first_cells(numbers)
        mark = "," if sum("," in cell for cell in cells) > sum("." in cell for cell in cells) else "."
        with self._open() as lines:
            rows = islice(self._rows(lines), 1, None)
            return first_bad_row(rows, Layout(self.names, numbers, self._delimiter_in_words(), mark))

    def _delimiter_in_words(self) -> str:
        return DELIMITERS.get(self.delimiter, repr(self.delimiter))


def open_text(path: Path, delimiter: str | None = None) -> DelimitedText:
    """Detect how the text file `path` is written, from its beginning; `delimiter` overrides detection.

    Raises:
        DataError: empty, no text, no header, or one column only.
    """
    with open(path, "rb") as file:
        start = file.read(SAMPLE_BYTES)
        is_whole = not file.read(1)
    text, encoding = _decoded(start, is_whole)
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
        raise DataError(
            "no rows in the first 256 kB", fix="save the table as CSV, one row per line, under a row with the names"
        )
    tried = repr(delimiter) if delimiter else ", ".join(DELIMITERS.values())
    delimiter = delimiter or max(DELIMITERS, key=lambda candidate: _fit(sample, candidate))
    names = tuple(name.strip() for name in next(_rows(iter(sample), delimiter))[1])
    if len(names) < 2:
        raise DataError(
            f"one column only, '{''.join(names)[:60]}'; columns are split by none of {tried}",
            where=f"line {above + 1}",
            fix="save the file as CSV, or write the character that separates columns as `delimiter` of the entry",
        )
    if all(NUMBER.fullmatch(name) or not name for name in names):
        raise DataError(
            f"no header: the first row holds numbers only ('{delimiter.join(names)[:60]}')",
            where=f"line {above + 1}",
            fix="write a row with the names of the columns above it",
        )
    if is_whole and len(list(_rows(iter(sample), delimiter))) < 2:
        raise DataError("a header, but no row of numbers", fix="export the file again")
    return DelimitedText(path, encoding, delimiter, above, names)


def _decoded(start: bytes, is_whole: bool) -> tuple[str, str]:
    """The text of the first bytes of a file, and its encoding."""
    encoding = next((name for mark, name in _ENCODINGS.items() if start.startswith(mark)), "utf-8")
    try:
        text = codecs.getincrementaldecoder(encoding)().decode(start, final=is_whole)
    except UnicodeDecodeError as error:
        line = start[: error.start].count(b"\n") + 1
        raise DataError(
            f"not {encoding}: {error.reason} (byte {start[error.start]:#04x})",
            where=f"line {line}",
            fix="save the file as 'CSV UTF-8', or write its header in plain letters",
        ) from error
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise DataError(
            "zero bytes: the file is UTF-16 without its mark, or no text",
            where=f"line {line}",
            fix="save the file as 'CSV UTF-8'",
        )
    if not text.strip():
        raise DataError("the file is empty", fix="export it again, with a header and rows of numbers")
    return text, encoding


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
        raise DataError(
            f"not readable: {error}", where=f"line {reader.line_num + 1}", fix="save the file as 'CSV UTF-8'"
        ) from error
