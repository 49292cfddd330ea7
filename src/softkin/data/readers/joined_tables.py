"""One table of several files: each row of one of them with its partners in the others."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import PurePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.data.missing_values import lacks_value
from softkin.data.readers.bad_rows import FIX_MISSING, listed
from softkin.data.readers.columns import choose
from softkin.data.readers.memory_table import Table
from softkin.data.readers.partner_rows import NEAREST, Partners, by_column, by_time, check_some, seconds

logger = logging.getLogger("softkin")

#: Below this share of rows with partners a join is probably not what was meant.
FEW = 0.5


class JoinedTables:
    """Tables of `files` (name, table), joined as the key `join` of the entry says. Columns keep their names; one whose
    name another file before has is called by its file, too: `export.time`.

    A row is one of the first file, with its partners in the others; where by a column the values repeat in one file, a
    row of that. After `read`, `unjoined` (n_rows,) says which rows lack a partner: they have gaps in its columns.
    """

    def __init__(self, files: Sequence[tuple[str, Table]], join: Mapping[str, Any], unpacked: object = None) -> None:
        """`unpacked` is what keeps the files, as long as the table is there."""
        self._files, self._join, self._unpacked = files, join, unpacked
        self.names: tuple[str, ...] = _distinct(files)
        self._places = [(part, place) for part, (_, table) in enumerate(files) for place in range(len(table.names))]

    @property
    def files(self) -> list[str]:
        """What they are called."""
        return [name for name, _ in self._files]

    @property
    def units(self) -> tuple[str, ...]:
        """Of all columns, empty where a file tells none."""
        told = [table.units or ("",) * len(table.names) for _, table in self._files]
        return tuple(unit for units in told for unit in units) if any(map(any, told)) else ()

    @property
    def unjoined(self) -> NDArray[np.bool_]:
        """Rows (n_rows,) that lack a partner."""
        return np.asarray(np.any([partners.rows < 0 for partners in self._partners], axis=0))

    def read(
        self, numbers: Sequence[int], others: Sequence[int], *, gaps: bool = False
    ) -> tuple[Array, list[NDArray[Any]]]:
        """See `Table`; rows without a partner have gaps in its columns whatever `gaps` says."""
        values = np.empty((len(self._partners[0].rows), len(numbers)))
        texts: dict[int, NDArray[Any]] = {}
        for part, partners in enumerate(self._partners):
            name, table = self._files[part]
            wanted = [(at, self._places[n][1]) for at, n in enumerate(numbers) if self._places[n][0] == part]
            more = [(n, self._places[n][1]) for n in others if self._places[n][0] == part]
            if not wanted and not more:
                continue
            try:
                found, columns = table.read([place for _, place in wanted], [place for _, place in more], gaps=True)
            except DataError as error:
                raise error.within(f"file {name}") from error
            values[:, [at for at, _ in wanted]] = partners.numbers(found)
            texts |= {n: partners.others(column) for (n, _), column in zip(more, columns, strict=True)}
        if not gaps:
            self._refuse_gaps(values, numbers)
        return values, [texts[n] for n in others]

    def look(self) -> list[NDArray[Any]]:
        """See `Table`."""
        return [
            partners.others(column)
            for (_, table), partners in zip(self._files, self._partners, strict=True)
            for column in table.look()
        ]

    def place(self, row: int) -> str:
        """Where row `row` stands in each file."""
        found = zip(self._files, self._partners, strict=True)
        places = [f"file {name}, {table.place(int(p.rows[row]))}" for (name, table), p in found if p.rows[row] >= 0]
        return " with ".join(places)

    def _refuse_gaps(self, values: Array, numbers: Sequence[int]) -> None:
        bad = np.isnan(values) & ~self.unjoined[:, None]
        if not bad.any():
            return
        rows = np.flatnonzero(bad.any(axis=1))
        part, place = self._places[numbers[int(np.argmax(bad[rows[0]]))]]
        name, table = self._files[part]
        partners = self._partners[part].rows
        count = f" ({listed('row', rows.tolist())})" if len(rows) > 1 else ""
        raise DataError(
            f"no value{count}",
            where=f"file {name}, {table.place(int(partners[rows[0]]))}, column '{table.names[place]}'",
            fix=FIX_MISSING,
        )

    @cached_property
    def _partners(self) -> list[Partners]:
        partners = JOINS[self._join["by"]](self._files, self._join)
        count = int(np.any([found.rows < 0 for found in partners], axis=0).sum())
        n_rows = len(partners[0].rows)
        if count:
            logger.log(
                logging.WARNING if count > (1 - FEW) * n_rows else logging.INFO,
                "%d of %d rows have no partner in another file and are left out",
                count,
                n_rows,
            )
        for (name, _), found in zip(self._files, partners, strict=True):
            used = found.rows[found.rows >= 0]
            if self._join["by"] == "time" and found.in_time is None and len(used) > 2 * len(np.unique(used)):
                logger.warning("each row of %s is the partner of several: name the file of fewer rows first", name)
        return partners


def _keys(files: Sequence[tuple[str, Table]], join: Mapping[str, Any]) -> list[NDArray[Any]]:
    """The column of the join in each file (n_rows_of_file,), text or numbers."""
    wanted = join["column"] if isinstance(join["column"], list) else [join["column"]] * len(files)
    if len(wanted) != len(files):
        what = f"{len(wanted)} columns for {len(files)} files"
        raise DataError(what, where="`join`", fix="name one `column` for each of the `files`, or one for all")
    keys = []
    for (name, table), column in zip(files, wanted, strict=True):
        try:
            _, (key,) = table.read([], choose(table.names, [column], "join"))
        except DataError as error:
            raise error.within(f"file {name}") from error
        keys.append(key)
    return keys


def _by_column(files: Sequence[tuple[str, Table]], join: Mapping[str, Any]) -> list[Partners]:
    keys = _keys(files, join)
    told = [key[~lacks_value(key)].tolist() for key in keys]
    repeats = [len(set(values)) < len(values) for values in told]
    base = repeats.index(True) if any(repeats) else 0
    found = [
        Partners(np.arange(len(key))) if part == base else by_column(keys[base], key, (files[base][0], files[part][0]))
        for part, key in enumerate(keys)
    ]
    for part, partners in enumerate(found):
        names = {"own": files[base][0], "other": files[part][0], "column": "column of the join"}
        check_some(partners, keys[base], keys[part], names)
        n_alone = len(keys[part]) - len(np.unique(partners.rows[partners.rows >= 0]))
        if n_alone:
            logger.info("%d of %d rows of %s have no partner", n_alone, len(keys[part]), files[part][0])
    return found


def _by_time(files: Sequence[tuple[str, Table]], join: Mapping[str, Any]) -> list[Partners]:
    columns = [seconds("column", key, table.place) for key, (_, table) in zip(_keys(files, join), files, strict=True)]
    found = [Partners(np.arange(len(columns[0])))]
    for part in range(1, len(files)):
        column = columns[part] + join.get("offset", 0.0)
        partners = by_time(columns[0], column, join["tolerance"], join.get("resample", NEAREST))
        names = {"own": files[0][0], "other": files[part][0], "column": "time"}
        check_some(partners, columns[0], column, names)
        found.append(partners)
    return found


def _by_row(files: Sequence[tuple[str, Table]], _join: Mapping[str, Any]) -> list[Partners]:
    sizes = [_size(table) for _, table in files]
    if len(set(sizes)) > 1:
        counted = ", ".join(f"{name} {size}" for (name, _), size in zip(files, sizes, strict=True))
        raise DataError(
            f"files of different numbers of rows: {counted}",
            where="`join`",
            fix="join by a column or by time, or bring the files to the same rows",
        )
    return [Partners(np.arange(size)) for size in sizes]


#: How rows of files are joined -> the partners of the rows in each file.
JOINS = {"column": _by_column, "time": _by_time, "row": _by_row}


def _size(table: Table) -> int:
    """The number of rows of a table, by its first column that can be read."""
    for place in range(len(table.names)):
        for numbers, others in (([place], []), ([], [place])):
            try:
                values, columns = table.read(numbers, others, gaps=True)
            except DataError:
                continue
            return len(values) if numbers else len(columns[0])
    return 0


def _distinct(files: Sequence[tuple[str, Table]]) -> tuple[str, ...]:
    """Names of all columns, those that a file before has with the name of the file."""
    stems = [PurePath(name).stem for name, _ in files]
    labels = [stem if stems.count(stem) == 1 else f"{stem}{place + 1}" for place, stem in enumerate(stems)]
    names: list[str] = []
    for label, (_, table) in zip(labels, files, strict=True):
        before = set(names)
        names += [f"{label}.{name}" if name in before else name for name in table.names]
    return tuple(names)
