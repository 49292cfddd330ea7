"""Columns of a delimited text file (CSV). Encoding, delimiter and decimal mark are detected and logged. Numbers are
rounded correctly: a float that was written with all its digits comes back to the bit.
"""

from __future__ import annotations

import io
import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.data.readers.bad_rows import MISSING, THOUSANDS, Layout, first_bad_row
from softkin.data.readers.memory_table import Table, from_cells, list_in, looked_at
from softkin.data.readers.text_layout import (
    BLANKS,
    DELIMITERS,
    SAMPLE_BYTES,
    SAMPLE_ROWS,
    TextLayout,
    layout_of,
    rows_of,
)

logger = logging.getLogger("softkin")

#: Rows that a guess is made from.
LOOKED_AT = 100_000


@dataclass(frozen=True, slots=True)
class DelimitedText:
    """A text file, and how it is written; `content` is its text where that is made and not in the file, `called` what
    a person calls the file.
    """

    path: Path
    layout: TextLayout
    content: bytes | None = None
    called: str = ""

    @property
    def names(self) -> tuple[str, ...]:
        """Of the columns, in their order."""
        return self.layout.names

    @property
    def units(self) -> tuple[str, ...]:
        """Of the columns, where a row of the file tells them; else empty."""
        return self.layout.units

    def read(
        self, numbers: Sequence[int], others: Sequence[int], *, gaps: bool = False
    ) -> tuple[Array, list[NDArray[Any]]]:
        """Columns by their places, each once: `numbers` as (n_rows, n_numbers), each of `others` as text (n_rows,).

        With `gaps` a cell of `numbers` may be empty, or hold one of `MISSING`: it becomes NaN.

        Raises:
            DataError: a cell of `numbers` is no finite number, or a row has more or fewer values than the header.
        """
        import pyarrow as pa

        reason = ""
        for mark, name in ((".", "points"), (",", "commas")):
            try:
                table = self._parse(numbers, others, mark, gaps)
            except pa.ArrowException as error:
                reason = str(error)
                continue
            values = np.empty((table.num_rows, len(numbers)))
            for place, number in enumerate(numbers):
                values[:, place] = table.column(f"c{number}").to_numpy()
            texts = [table.column(f"c{other}").to_numpy().astype(object) for other in others]
            if not np.isfinite(values).all() and not (gaps and not np.isinf(values).any()):
                break
            if numbers:
                how = self.layout.encoding, self._delimiter_in_words(), name, self.called or self.path.name
                logger.info("read as %s, columns split by %s, decimal %s: %s", *how)
            if mark == "," and all(THOUSANDS.fullmatch(cell) for cell in self._first_cells(numbers) if "," in cell):
                remark = DataError(
                    "numbers such as 1,234 were read as decimal commas (1.234)",
                    where=self.path,
                    fix="if they are thousands, save the file without separators of thousands",
                )
                logger.warning("%s", remark)
            return values, texts
        raise self._first_bad_row(numbers, gaps) or DataError(
            f"not readable as CSV: {reason}", fix="save the file as CSV anew"
        )

    def place(self, row: int) -> str:
        """Where row `row` (from 0, without the header) stands in the file."""
        with self._open() as lines:
            return f"line {next(islice(self._rows(lines), row, None))[0]}"

    def rows(self, most: int | None) -> list[tuple[int, list[str]]]:
        """(line, cells) of the first rows, at `most` so many."""
        with self._open() as lines:
            return list(islice(self._rows(lines), most))

    def look(self) -> list[NDArray[Any]]:
        """The columns of the first `LOOKED_AT` rows as far as they can be read: numbers, with NaN where there is none,
        or text, where most cells hold no number.
        """
        cells = [row for _, row in self.rows(LOOKED_AT) if len(row) == len(self.names)]
        return [looked_at([row[place].strip() for row in cells]) for place in range(len(self.names))]

    def _parse(self, numbers: Sequence[int], others: Sequence[int], mark: str, gaps: bool) -> Any:
        import pyarrow as pa
        from pyarrow import csv as arrow

        chosen = {f"c{place}": pa.float64() for place in numbers} | {f"c{place}": pa.string() for place in others}
        return arrow.read_csv(
            self._source(),
            arrow.ReadOptions(
                use_threads=False,
                encoding="utf-16" if self.layout.encoding == "utf-16" and not self._has_blanks() else "utf8",
                column_names=[f"c{place}" for place in range(len(self.names))],
                skip_rows=self.layout.lines_above,
                skip_rows_after_names=self.layout.header_rows,
            ),
            # Only a header ever has line breaks within quotes; looking out for them costs time.
            arrow.ParseOptions(delimiter=self.layout.delimiter, newlines_in_values="\n" in "".join(self.names)),
            arrow.ConvertOptions(
                column_types=chosen,
                include_columns=list(chosen),
                null_values=[*MISSING] if gaps else [],
                decimal_point=mark,
            ),
        )

    def _has_blanks(self) -> bool:
        return self.layout.delimiter == BLANKS

    def _source(self) -> Any:
        """What arrow reads: the file, or where runs of blanks split its columns its text with one blank each."""
        import pyarrow as pa

        if not self._has_blanks():
            return self.path if self.content is None else pa.BufferReader(self.content)
        with self._open() as lines:
            text = "\n".join(" ".join(line.split()) for line in lines)
        return pa.BufferReader(text.encode())

    def _open(self) -> io.TextIOWrapper:
        if self.content is not None:
            return io.TextIOWrapper(io.BytesIO(self.content), encoding=self.layout.encoding, newline="")
        return open(self.path, encoding=self.layout.encoding, newline="")

    def _rows(self, lines: Iterator[str]) -> Iterator[tuple[int, list[str]]]:
        """(line on which it ends, cells) of each row that is not blank, without header and units."""
        above = self.layout.lines_above
        for _ in range(above):
            next(lines)
        rows = islice(rows_of(lines, self.layout.delimiter), self.layout.header_rows, None)
        return ((above + line, row) for line, row in rows)

    def _first_cells(self, numbers: Sequence[int]) -> list[str]:
        with self._open() as lines:
            rows = [row for _, row in islice(self._rows(lines), SAMPLE_ROWS) if len(row) == len(self.names)]
        return [row[place].strip(" \t") for row in rows for place in numbers]

    def _first_bad_row(self, numbers: Sequence[int], gaps: bool) -> DataError | None:
        cells = self._first_cells(numbers)
        mark = "," if sum("," in cell for cell in cells) > sum("." in cell for cell in cells) else "."
        with self._open() as lines:
            return first_bad_row(self._rows(lines), Layout(self.names, numbers, self._delimiter_in_words(), mark, gaps))

    def _delimiter_in_words(self) -> str:
        return DELIMITERS.get(self.layout.delimiter, repr(self.layout.delimiter))


def open_text(
    path: Path, delimiter: str | None = None, header: str | int | None = None, content: bytes | None = None
) -> DelimitedText:
    """Detect how the text file `path` is written, from its beginning; `delimiter` and `header` override detection, and
    `content` is read in its place.

    Raises:
        DataError: empty, no text, no header, or one column only.
    """
    with open(path, "rb") if content is None else io.BytesIO(content) as file:
        start = file.read(SAMPLE_BYTES)
        is_whole = not file.read(1)
    layout = layout_of(start, is_whole, delimiter, header)
    if layout.lines_above:
        logger.info("%d lines above the rows are not read", layout.lines_above)
    return DelimitedText(path, layout, content)


def open_table(path: Path, source: Mapping[str, Any]) -> Table:
    """The table in the text file `path`, by the keys `delimiter` and `header` of its entry.

    Raises:
        DataError: as `open_text` and `with_lists`.
    """
    text = open_text(path, source.get("delimiter"), source.get("header"))
    return with_lists(replace(text, called=source.get("file", "")))


def with_lists(text: DelimitedText) -> Table:
    """The table of a text; where cells hold lists, with a column for each of their numbers.

    Raises:
        DataError: lists of one column have different lengths.
    """
    rows = text.rows(1)
    if not any(list_in(cell) for _, row in rows for cell in row):
        return text
    rows = text.rows(None)
    wrong = next(((line, row) for line, row in rows if len(row) != len(text.names)), None)
    if wrong is not None:
        raise DataError(
            f"{len(wrong[1])} values, but the header names {len(text.names)} columns",
            where=f"line {wrong[0]}",
            fix="put lists within quotes, one to a cell",
        )
    logger.info("cells hold lists: a column for each of their numbers")
    columns = [[row[place] for _, row in rows] for place in range(len(text.names))]
    return from_cells(text.names, columns, lambda row: f"line {rows[row][0]}")
