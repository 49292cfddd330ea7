"""Guess the entry of config/datasets.yaml that a robot's own table needs: columns, unit and split."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from softkin.cli import column_kinds
from softkin.cli.column_kinds import kind_of
from softkin.cli.guess_orientation import orientation_key, question_of_orientation, rotations
from softkin.cli.guess_questions import ASKED, PIXELS, Question, question_of, reasons_left_out, words_of
from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.core.units import MM_PER_UNIT
from softkin.data import split
from softkin.data.orientation import KEY
from softkin.data.readers.columns import axis_of, marker_by_marker, unit_of
from softkin.data.readers.memory_table import Table
from softkin.data.readers.table_formats import open_table
from softkin.data.recordings import check_placed, recording_of

#: A table, and its columns by their names.
Looked = tuple[Table, Mapping[str, Any]]
#: Parts of a column's name that say one power-on of the robot.
SESSION = re.compile(r"session|trial|run")
#: A workspace wider than this is taken to be in mm: no robot is so many metres wide.
LARGEST_METRES = 5.0
#: A camera's unit; what a row of units or a name may say of positions.
PX = "px"
UNITS = frozenset({*MM_PER_UNIT, PX, "pixel", "pixels"})


def guess_entry(
    path: Path,
    title: str,
    file: str,
    options: Mapping[str, Any] | None = None,
    answer: int = 0,
    seen: Looked | None = None,
) -> tuple[dict[str, Any], list[str]]:
    """The entry that the table at `path` probably needs, and a sentence on each key that was guessed. `file` is the
    path that the entry names; `options` are keys of the entry that say how the file is read; `answer` is 0 or 1, where
    the table raises a question (`asked`); `seen` is what `look` found at the path, where that is known.

    Raises:
        DataError: the file cannot be read, or its columns do not tell which are positions and commands.
    """
    try:
        table, looked = look(path, options) if seen is None else seen
        question, of_turn = _questions(table.names, looked)
        asked_out = () if question is None else question.left_out[answer]
        told = question.as_commands if question is not None and answer else ()
        left = [*column_kinds.computed(table.names), *rotations(table.names, looked), *asked_out, *told]
        usable = [name for name in table.names if name not in left]
        positions, dimensions, reasons = _positions(usable, path)
        kinds = {name: kind_of(name) for name in usable if name not in positions}
        numeric = {name: kind for name, kind in kinds.items() if looked[name].dtype != object}
        commands, why_commands = _commands(numeric, table.names, path, told)
        reasons += why_commands
        values, missing, why_missing = _values(table, [*commands, *positions], looked)
        inputs, values = values[:, : len(commands)], values[:, len(commands) :]
    except DataError as error:
        raise error if error.where == str(path) else error.within(str(path)) from error
    if not len(values):
        raise DataError("a header, but no row of numbers", where=path, fix="export the file again")
    unit, why_unit = _unit(positions, values, path, table)
    split_options, why_split = _split(table, kinds)
    entry: dict[str, Any] = {"title": title, "format": "table_file", "file": file, **(options or {})}
    entry |= {"position_unit": unit, "commands": commands, "positions": positions, "split": split_options}
    when, why_when = _when(table, kinds)
    turned, why_turned = orientation_key(table.names, looked, answer if of_turn else None)
    if not when and split_options["method"] == "random" and column_kinds.are_alike(inputs):
        if running := column_kinds.running_number(kinds, looked):
            when, split_options = {"order": running}, {"method": "later"}
            why_split = f"order, split: '{running}' is a running number and rows in turn are alike; please check"
        else:
            reasons.append("order: rows in turn are alike, as of a recording: add a column of its time to the file")
    entry |= when | missing | turned
    entry["split"] = split_options
    if column_kinds.affine_copies(inputs, values):
        reasons.append(f"suspicious_affine: an affine map of {', '.join(commands)} gives the positions; please check")
    reasons += [*why_turned, why_unit, why_split, *why_when, *why_missing]
    if dimensions == 2:
        entry["dimensions"] = 2
        reasons.append("dimensions: positions of two axes only, so a planar robot")
    used = (*commands, *positions, split_options.get("column"), *when.values(), *turned.get(KEY, {}).get("columns", ()))
    if left_out := [name for name in table.names if name not in used]:
        named = {name: ASKED if name in asked_out else kind_of(name) for name in left_out}
        reasons.append(f"left out: {reasons_left_out(left_out, looked, named)}")
    return entry, reasons


def asked(path: Path, options: Mapping[str, Any] | None = None, seen: Looked | None = None) -> Question | None:
    """The question that the table at `path` raises, None without one; `guess_entry` takes the answer, and `seen`.

    Raises:
        DataError: the file cannot be read.
    """
    table, looked = look(path, options) if seen is None else seen
    return _questions(table.names, looked)[0]


def _questions(names: Sequence[str], looked: Mapping[str, Any]) -> tuple[Question | None, bool]:
    """What is asked, one question at a time, and whether it is of the orientation."""
    question = question_of(names, looked)
    return (question, False) if question is not None else (question_of_orientation(names, looked), True)


def look(path: Path, options: Mapping[str, Any] | None) -> Looked:
    """The table at `path`, and its columns (n_rows,) as far as they can be read.

    Raises:
        DataError: the file cannot be read.
    """
    try:
        table = open_table(path, options or {})
        return table, dict(zip(table.names, table.look(), strict=True))
    except DataError as error:
        raise error if error.where == str(path) else error.within(str(path)) from error


def _positions(names: Sequence[str], path: Path) -> tuple[list[str], int, list[str]]:
    """Columns of positions, marker by marker, how many per marker, and what a person must check of them."""
    named = {name: axis for name in names if (axis := axis_of(name)) and kind_of(name) != "no position"}
    for axes in ("xyz", *combinations("xyz", 2)):
        complete = [
            name for name, (rest, _) in named.items() if sorted(a for r, a in named.values() if r == rest) == [*axes]
        ]
        if complete:
            columns = [name for name in complete if kind_of(name) != "command"] or complete
            return marker_by_marker(columns), len(axes), []
    numbered = column_kinds.numbered_positions([name for name in names if kind_of(name) is None])
    if numbered:
        return numbered, 3, ["positions: three numbered columns of one name; please check"]
    raise DataError(
        f"no columns look like positions: {', '.join(names[:40])}",
        where=path,
        fix="name them m1_x, m1_y, m1_z, m2_x, ..., or write the entry by hand, see config/README.md",
    )


def _commands(
    kinds: Mapping[str, str | None], names: Sequence[str], path: Path, told: Sequence[str]
) -> tuple[list[str], list[str]]:
    """Columns of commands, those that a person says are `told` the robot among them, and what is to be checked."""
    commands = [*(name for name, kind in kinds.items() if kind == "command"), *told]
    if commands:
        return commands, []
    unknown = [name for name, kind in kinds.items() if kind is None]
    if not unknown:
        raise DataError(
            f"no column looks like a command: {', '.join(names[:40])}",
            where=path,
            fix="name them u1, u2, ..., or write the entry by hand, see config/README.md",
        )
    return unknown, ["commands: all columns that look like nothing else; please check"]


def _values(table: Table, names: Sequence[str], looked: Mapping[str, Any]) -> tuple[Array, dict[str, str], list[str]]:
    """Values (n_rows, n_names) of columns, the key `missing` where some are, and why; of the rows that were `looked` at
    where the file cannot be read to its end.

    Raises:
        DataError: no row holds all numbers.
    """
    places = [table.names.index(name) for name in names]
    try:
        return table.read(places, [])[0], {}, []
    except DataError as error:
        whole = error
    try:
        values, _ = table.read(places, [], gaps=True)
    except DataError:
        seen = [looked[name] if looked[name].dtype != object else np.full(len(looked[name]), np.nan) for name in names]
        good = np.column_stack(seen)
        good = good[~np.isnan(good).any(axis=1)]
        if not len(good):
            raise whole from None
        return good, {}, [f"guessed from {len(good)} rows, since the file is not readable to its end"]
    count = int(np.isnan(values).any(axis=1).sum())
    why = f"missing: {count} of {len(values)} rows lack a number and are left out; please check"
    return values[~np.isnan(values).any(axis=1)], {"missing": "drop_rows"}, [why]


def _unit(names: Sequence[str], values: Array, path: Path, table: Table) -> tuple[str, str]:
    """The unit of the positions, and why."""
    told = {table.units[table.names.index(name)] for name in names} if table.units else set()
    if len(told) == 1 and told <= UNITS:
        unit = told.pop()
        return unit, f"position_unit: the row of units says {unit}"
    units = {unit_of(name) for name in names}
    if len(units - {None}) > 1:
        raise DataError(
            f"positions in different units: {', '.join(names)}", where=path, fix="bring all columns to one unit"
        )
    if None not in units:
        unit = str(units.pop())
        return unit, f"position_unit: the columns' names say {unit}"
    extent = np.ptp(values, axis=0).max()
    if any(words_of(name) & PIXELS for name in names):
        return PX, "position_unit: the names say pixels, which stay pixels: no length is known of them; please check"
    unit = "m" if extent <= LARGEST_METRES else "mm"
    beside = next((name for name in table.names if words_of(name) & PIXELS), None)
    hint = "" if beside is None else f" ({PX} if these are pixels, as '{beside}' seems to be)"
    return unit, f"position_unit: guessed from the width of the workspace, {extent:.3g}; please check{hint}"


def _when(table: Table, kinds: Mapping[str, str | None]) -> tuple[dict[str, str], list[str]]:
    """Columns of the order and the session of rows, and what a person must check of them; none where they are no
    order, or sessions are not in one piece.
    """
    order = next((name for name, kind in kinds.items() if kind == "time"), None)
    session = next((name for name, kind in kinds.items() if kind == "group" and SESSION.search(name.lower())), None)
    named = {key: name for key, name in (("order", order), ("session", session)) if name is not None}
    if not named:
        return {}, []
    _, columns = table.read([], [table.names.index(name) for name in named.values()])
    by = dict(zip(named, columns, strict=True))
    try:
        recording = recording_of(np.zeros((len(columns[0]), 1)), by.get("order"), by.get("session"), table.place)
        unjoined = getattr(table, "unjoined", None)
        check_placed(recording if unjoined is None else recording.take(~unjoined), table.place)
    except DataError as error:
        return {}, [f"order, session: left out, since {' and '.join(named.values())} are none: {error.what}"]
    return named, [f"{', '.join(named)}: guessed from the names of columns, so that memory can be found; please check"]


def _split(table: Table, kinds: Mapping[str, str | None]) -> tuple[dict[str, Any], str]:
    """The options of the split, and why."""
    by_kind = {kind: name for name, kind in reversed(list(kinds.items()))}
    if name := by_kind.get("subset"):
        _, (column,) = table.read([], [table.names.index(name)])
        if {str(value).strip() for value in column} <= set(split.SPELLINGS):
            return {"method": "column", "column": name}, f"split: '{name}' names the subsets"
    for kind in ("group", "time"):
        if name := by_kind.get(kind):
            return {"method": kind, "column": name}, f"split: by {kind}, since there is a column '{name}'"
    return {"method": "random"}, "split: at random, rows of the same command together"
