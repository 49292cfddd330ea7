"""Guess how the rows of several files belong together: by a column of equal values, by time, or by their number."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.cli.column_kinds import is_running, kind_of
from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.data.readers.memory_table import Table, row_from_0
from softkin.data.readers.partner_rows import seconds

#: A column joins files where at least this share of the values of the file of fewer rows stands in the other.
SHARED = 0.5
#: Recordings that last so many times as long as their partner are in milliseconds and seconds.
OTHER_UNIT = 300.0
Files = Sequence[tuple[str, Table]]


def guess_join(files: Files, wanted: str | None = None) -> tuple[dict[str, Any], list[str]]:
    """The key `join` of the entry of a robot in these `files` (name, table), and a sentence on why; another way that is
    possible, too, is named in it.

    Raises:
        DataError: nothing tells it, or not what is `wanted`.
    """
    looked = [dict(zip(table.names, table.look(), strict=True)) for _, table in files]
    ways = {"column": _by_column(looked), "time": _by_time(looked), "row": _by_row(looked)}
    possible = {name: way for name, way in ways.items() if way is not None}
    chosen = wanted or next(iter(possible), None)
    if chosen == "row" and wanted is None and all(any(kind_of(n) == "time" for n in columns) for columns in looked):
        chosen = None  # times that tell nothing are no reason to count rows
    if chosen not in possible:
        columns = "; ".join(f"{name}: {', '.join(table.names[:12])}" for name, table in files)
        raise DataError(
            f"nothing tells how rows of the files belong together{f' by {wanted}' if wanted else ''} ({columns})",
            where="FILE",
            fix="give them a column of one name with the number of each row, or columns of time, or equally many rows",
        )
    join, why = possible[chosen]
    others = [
        f"join: {{{_in_one_line(way)}}}" for name, (way, _) in possible.items() if name != chosen and name != "row"
    ]
    asked = f"; or is it {' or '.join(others)}?" if others else ""
    return join, [f"join: {why}; please check{asked}"]


def _in_one_line(join: Mapping[str, Any]) -> str:
    return ", ".join(f"{key}: {value}" for key, value in join.items()).replace("'", "")


def _by_column(looked: Sequence[Mapping[str, NDArray[Any]]]) -> tuple[dict[str, Any], str] | None:
    """A column of one name in all files whose values tell the rows apart in all of them but one."""
    for name in looked[0]:
        if not all(name in columns for columns in looked) or kind_of(name) not in ("ignored", "group", "command"):
            continue
        keys = [set(columns[name].tolist()) for columns in looked]
        n_repeating = sum(len(values) < len(columns[name]) for values, columns in zip(keys, looked, strict=True))
        n_shared = len(set.intersection(*keys))
        if n_repeating <= 1 and n_shared >= SHARED * min(map(len, keys)):
            starts = {f"{columns[name].min():g}" for columns in looked if is_running(columns[name])}
            shifted = f", which starts at {' and at '.join(sorted(starts))}: are rows counted alike?"
            why = f"rows of equal '{name}', {n_shared} values in all files{shifted * (len(starts) > 1)}"
            return {"by": "column", "column": name}, why
    return None


def _by_time(looked: Sequence[Mapping[str, NDArray[Any]]]) -> tuple[dict[str, Any], str] | None:
    """Columns of time, one in each file; a partner is at most one step of the others away.

    Raises:
        DataError: the times of the files are in different units.
    """
    found = [_rising_times(columns) for columns in looked]
    names = [name for name, _ in found]
    if any(name is None for name in names):
        return None
    times = [values for _, values in found]
    _check_units([str(name) for name in names], times)
    step = max(float(np.median(np.diff(column))) for column in times[1:])
    join: dict[str, Any] = {"by": "time", "column": names[0] if len(set(names)) == 1 else names}
    join["tolerance"] = float(f"{step:.3g}")
    why = f"the nearest in time, at most one step of the other file away ({step:.3g})"
    if not any(column[0] <= times[0][-1] and times[0][0] <= column[-1] for column in times[1:]):
        join["offset"] = float(times[0][0] - times[1][0])
        why += ", where both clocks are taken to start together, since their times do not overlap"
    rarer = float(np.median(np.diff(times[0]))) / step
    if rarer > 5:
        why += (
            f"; the first file has a row for {rarer:.0f} of the other, so if its values hold until the next, name the "
        )
        why += "other file first and write resample: hold"
    return join, why


def _by_row(looked: Sequence[Mapping[str, NDArray[Any]]]) -> tuple[dict[str, Any], str] | None:
    sizes = {len(next(iter(columns.values()))) for columns in looked}
    return ({"by": "row"}, f"row by row, since all have {min(sizes)}") if len(sizes) == 1 else None


def _rising_times(columns: Mapping[str, NDArray[Any]]) -> tuple[str | None, Array]:
    """The first column of time whose values grow, as numbers, dates in seconds; None where there is none."""
    for name, column in columns.items():
        if kind_of(name) != "time":
            continue
        try:
            values = seconds(name, column, row_from_0)
        except DataError:
            continue
        if len(values) > 2 and (np.diff(values) >= 0).all() and values[-1] > values[0]:
            return name, values
    return None, np.empty(0)


def _check_units(names: Sequence[str], times: Sequence[Array]) -> None:
    """The files last equally long, or nearly, as far as a unit of time can tell."""
    spans = [float(values[-1] - values[0]) for values in times]
    for name, span in zip(names[1:], spans[1:], strict=True):
        if max(span, spans[0]) > OTHER_UNIT * min(span, spans[0]):
            raise DataError(
                f"times in different units? '{names[0]}' goes on for {spans[0]:.6g}, '{name}' for {span:.6g}",
                where="FILE",
                fix="bring all times to seconds",
            )
