"""Reader of a robot's own table: a file with one row per pose, columns of commands and of positions.

The entry names the columns (a list, or a pattern), the number of coordinates per marker and how to split the rows.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.recording import Recording
from softkin.core.samples import EXTRAPOLATION, MAX_MAGNITUDE, ROWS_FOR_95_PERCENT, SUBSETS, VALIDATION, Array, Samples
from softkin.data import orientation, split
from softkin.data.blocks import blocks
from softkin.data.own_files import in_words
from softkin.data.readers import columns
from softkin.data.readers.complete_rows import REFUSE, whole
from softkin.data.readers.memory_table import Table
from softkin.data.readers.table_formats import open_table
from softkin.data.recordings import check_placed, recording_of

logger = logging.getLogger("softkin")

#: Keys of the entry whose columns say when rows were recorded.
WHEN = ("order", "session")
#: Keys of the entry whose columns are the robot.
COLUMNS = ("commands", "positions")
#: Gets what a reader tells besides the rows, where somebody asks for it.
Told = dict[str, Any] | None
#: A marker's range this many times that of the next narrower suggests that they are in different units: along an arm
#: ranges grow gradually.
SUSPICIOUS_GAP = 100.0


def read(
    path: str | Path, *, dataset: str, source: Mapping[str, Any], counts: Told = None, own_columns: Told = None
) -> dict[str, Samples]:
    """Samples per subset, rows in the order of the file, positions in its own unit; planar ones get a third
    coordinate 0. `counts` gets what was left out, by the names of `complete_rows.COUNTED`, as the entry asks for it;
    `own_columns` the names of `commands`, `positions` and `unused_columns`, and the `dimensions` of a marker.

    Memory is computed before rows are left out, and not across a row whose command is missing.

    Raises:
        DataError: the file is not what its entry `source` says; names the file, row and column.
    """
    where = f"dataset '{dataset}', file {in_words(source)}"
    try:
        table = open_table(path, source)
        commands, coordinates, named = _chosen(table.names, source)
        chosen = [*commands, *coordinates]
        turned = orientation.places(table.names, source, [*chosen, *named.values()])
        names = [table.names[place] for place in chosen]
        n_commands, dimensions = len(commands), source.get("dimensions", 3)
        _tell(own_columns, dimensions=dimensions, **_named(table.names, chosen, n_commands, [*named.values(), *turned]))
        missing = source.get("missing", REFUSE)
        others = [place for place in dict.fromkeys(named.values()) if place not in chosen]
        numbers, read_others = table.read([*chosen, *turned], others, gaps=missing != REFUSE)
        values, rotations = numbers[:, : len(chosen)], orientation.without_zeros(numbers[:, len(chosen) :], source)
        by_place = dict(zip(others, read_others, strict=True)) | dict(zip(chosen, values.T, strict=True))
        by = {key: by_place[place] for key, place in named.items()}
        if not len(values):
            raise DataError("a header, but no row of numbers", fix="export the file again")
        left = whole(
            np.hstack([values[:, :n_commands], rotations]),
            values[:, n_commands:],
            names[n_commands:],
            dimensions=dimensions,
            missing=missing,
            unjoined=getattr(table, "unjoined", None),
            place=table.place,
        )
        _tell(counts, **left.counts)
        recording = _recording(values[:, :n_commands], by, table.place, left.rows)
        names = [*names[:n_commands], *(names[n_commands + place] for place in left.coordinates)]
        values = values[np.ix_(left.rows, [*range(n_commands), *(n_commands + left.coordinates)])]
        place = partial(_place, table, left.rows)
        _check_magnitudes(names, values, place)
        samples = Samples(values[:, :n_commands], _spatial(values[:, n_commands:], dimensions), recording)
        samples = replace(samples, orientation=orientation.vectors_of(rotations[left.rows], source, place))
        column = by["split"][left.rows] if "split" in by else None
        how = (source["split"], samples.commands, column, place)
        subset_of, samples = split.split(*how, recording), replace(samples, block=blocks(*how))
        sizes = dict(zip(SUBSETS, np.bincount(subset_of, minlength=len(SUBSETS)).tolist(), strict=True))
        split.check_sizes(sizes)
    except DataError as error:
        raise error.within(where) from error
    for what, fix in (
        *_remarks_on_columns(names, values, n_commands, dimensions, source["position_unit"]),
        *_remarks_on_sizes(sizes, split.wanted_shares(source["split"])),
    ):
        logger.warning("%s", DataError(what, where=where, fix=fix))
    del values
    return _by_subset(samples, subset_of)


def _named(names: Sequence[str], chosen: Sequence[int], n_commands: int, others: Iterable[int]) -> dict[str, Any]:
    """What columns of commands and of positions are called, and those of which the entry names none."""
    used = {*chosen, *others}
    unused = [name for place, name in enumerate(names) if place not in used]
    of_robot = [names[place] for place in chosen]
    return {"commands": of_robot[:n_commands], "positions": of_robot[n_commands:], columns.UNUSED: unused}


def _tell(somebody: Told, **what: Any) -> None:
    if somebody is not None:
        somebody |= what


def _place(table: Table, kept: NDArray[np.intp], row: int) -> str:
    """Where row `row` of those that are `kept` stands in the file."""
    return table.place(int(kept[row]))


def _by_subset(samples: Samples, subset_of: split.Codes) -> dict[str, Samples]:
    """The rows of each subset that has some."""
    return {
        subset: samples.take(rows)
        for place, subset in enumerate(SUBSETS)
        if len(rows := np.flatnonzero(subset_of == place))
    }


def _chosen(names: Sequence[str], source: Mapping[str, Any]) -> tuple[list[int], list[int], dict[str, int]]:
    """Places of the columns of commands, of coordinates, and of what else the entry names, checked."""
    commands, coordinates = (columns.choose(names, source[key], key) for key in COLUMNS)
    named = {
        key: columns.choose(names, [column], key)[0]
        for key, column in (("split", source["split"].get("column")), *((key, source.get(key)) for key in WHEN))
        if column is not None
    }
    of_commands, of_coordinates = ([names[place] for place in places] for places in (commands, coordinates))
    columns.check(of_commands, of_coordinates, source.get("dimensions", 3), source)
    return commands, coordinates, named


def _recording(
    commands: Array, by: Mapping[str, Any], place: Callable[[int], str], kept: NDArray[np.intp]
) -> Recording | None:
    """The recording of the rows that are `kept`, as the columns `by` of order and session of all rows tell it; None
    where the entry names neither.
    """
    if not any(key in by for key in WHEN):
        return None
    recording = recording_of(commands, by.get("order"), by.get("session"), place).take(kept)
    check_placed(recording, lambda row: place(int(kept[row])))
    return recording


def _spatial(positions: Array, dimensions: int) -> Array:
    """Positions with three coordinates per marker: a planar marker's third is 0."""
    if dimensions == 3:
        return positions
    markers = positions.reshape(len(positions), -1, dimensions)
    return np.pad(markers, ((0, 0), (0, 0), (0, 1))).reshape(len(positions), -1)


def _check_magnitudes(names: Sequence[str], values: Array, place: Callable[[int], str]) -> None:
    for name, column in zip(names, values.T, strict=True):
        if np.abs(column).max() > MAX_MAGNITUDE:
            row = int(np.argmax(np.abs(column)))
            raise DataError(
                f"too large a number: {column[row]:g}",
                where=f"{place(row)}, column '{name}'",
                fix="correct the value or delete the row",
            )


def _remarks_on_sizes(sizes: Mapping[str, int], wanted: Mapping[str, float]) -> Iterator[tuple[str, str]]:
    """What is suspicious about the sizes of the subsets, and its fix."""
    n_rows = sum(sizes.values())
    if sizes[VALIDATION] < ROWS_FOR_95_PERCENT:
        yield (
            f"validation has {sizes[VALIDATION]} rows, too few for a calibrated interval at 95 %",
            f"record more rows, so that it has {ROWS_FOR_95_PERCENT} or more",
        )
    off = {subset: share for subset, share in wanted.items() if abs(sizes[subset] / n_rows - share) > 0.05}
    if off:
        shares = ", ".join(f"{subset} {sizes[subset] / n_rows:.0%} for {share:.0%}" for subset, share in off.items())
        yield (
            f"large groups of rows stay together, so subsets miss their share: {shares}",
            f"record more distinct commands or groups, or write another `{EXTRAPOLATION}_share` of `split`",
        )


def _remarks_on_columns(
    names: Sequence[str], values: Array, n_commands: int, dimensions: int, position_unit: str
) -> Iterator[tuple[str, str]]:
    """What is suspicious about the columns, and its fix."""
    first_names: dict[int, str] = {}
    for place, name in enumerate(names):
        column = values[:, place]
        if not np.ptp(column) > 0:
            if place < n_commands:
                yield f"command '{name}' is always {column[0]:g}", "leave it out of `commands`"
            continue
        twin = first_names.setdefault(hash(column.tobytes()), name)
        if twin != name:
            yield f"columns '{twin}' and '{name}' hold the same numbers", "leave one out, or export the file again"
    if n_commands > columns.MANY_COMMANDS:
        yield (
            f"{n_commands} commands: a fit of trees takes {n_commands / columns.MANY_COMMANDS:.1f} times as long as of "
            f"{columns.MANY_COMMANDS}, a recording has six more inputs for each, and polynomials keep squares alone",
            "leave out of `commands` what says nothing new, or boosted trees out of `models` (docs/scaling.md)",
        )
    units = {unit for name in names[n_commands:] if (unit := columns.unit_of(name))}
    if units - {position_unit}:
        yield (
            f"the names of the columns say {', '.join(sorted(units))}, but `position_unit` says {position_unit}",
            "correct `position_unit`, or bring all columns to one unit",
        )
    sample = values[:: max(1, len(values) // 10_000), n_commands:]
    ranges = np.subtract(*np.percentile(sample, [99, 1], axis=0)).reshape(-1, dimensions).max(axis=1)
    moving = np.flatnonzero(ranges > 1e-9 * ranges.max(initial=0.0))
    order = moving[np.argsort(ranges[moving])]
    gaps = ranges[order[1:]] / ranges[order[:-1]]
    if gaps.max(initial=0.0) > SUSPICIOUS_GAP:
        place = int(gaps.argmax())
        narrow, wide = (names[n_commands + dimensions * int(marker)] for marker in order[place : place + 2])
        yield (
            f"mixed units? the marker of '{wide}' ranges over {ranges[order[place + 1]]:g}, that of '{narrow}' over "
            f"{ranges[order[place]]:g}, {gaps[place]:.0f} times less, and none in between",
            "bring all markers to one unit; if the second is fixed to the base, leave it out",
        )
