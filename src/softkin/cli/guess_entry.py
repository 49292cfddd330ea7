"""Guess the entry of config/datasets.yaml that a robot's own table needs: columns, unit and split."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations, product
from pathlib import Path
from typing import Any

import numpy as np

from softkin.cli import column_kinds
from softkin.cli.column_kinds import kind_of
from softkin.cli.guess_missing import values_of
from softkin.cli.guess_orientation import orientation_key, question_of_orientation, rotations
from softkin.cli.guess_questions import ASKED, PIXELS, Question, question_of, reasons_left_out, words_of
from softkin.cli.guess_split import of_recording, split_of, when_recorded
from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.core.units import LENGTHS, reason_against
from softkin.data.orientation import KEY
from softkin.data.readers.columns import family_of, marker_by_marker, unit_of
from softkin.data.readers.memory_table import Table
from softkin.data.readers.table_formats import open_table

#: A table, and its columns by their names.
Looked = tuple[Table, Mapping[str, Any]]
#: A workspace wider than this is taken to be in mm: no robot is so many metres wide.
LARGEST_METRES = 5.0
#: A workspace narrower than this may be in cm as well as in mm.
NARROW_MM = 60.0
#: A camera's unit; what a row of units or a name may say of positions.
PX = "px"


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
        commands, why_commands = _commands(numeric, looked, path, told)
        reasons += why_commands
        inputs, values, missing, why_missing = values_of(table, commands, positions, dimensions, looked)
    except DataError as error:
        raise error if error.where == str(path) else error.within(str(path)) from error
    if not len(values):
        raise DataError("a header, but no row of numbers", where=path, fix="export the file again")
    unit, why_unit = _unit(positions, values, path, table)
    entry: dict[str, Any] = {"title": title, "format": "table_file", "file": file, **(options or {})}
    entry |= {"position_unit": unit, "commands": commands, "positions": positions}
    when, why_when = when_recorded(table, kinds)
    split_options, why_split = split_of(table, kinds, when, "files" in (options or {}))
    turned, why_turned = orientation_key(table.names, looked, answer if of_turn else None)
    if not when and split_options["method"] == "random":
        when, split_options, why_split = of_recording(inputs, commands, kinds, looked) or (
            when,
            split_options,
            why_split,
        )
    entry |= {"split": split_options} | when | missing | turned
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
    measured = [name for name in names if name not in column_kinds.computed(names)]
    question = question_of(measured, looked)
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
    usable = [name for name in names if kind_of(name) != "no position"]
    for axes, by_unit in product(("xyz", *combinations("xyz", 2)), (True, False)):
        named = {name: family for name in usable if (family := family_of(name, by_unit))}
        complete = [
            name
            for name, (rest, _) in named.items()
            if sorted(axis for other, axis in named.values() if other == rest) == [*axes]
        ]
        if complete:
            columns = [name for name in complete if kind_of(name) != "command"] or complete
            return marker_by_marker(columns), len(axes), []
    told = [name for name in names if kind_of(name) == "command"]
    for candidates in ([name for name in names if kind_of(name) is None], told):
        numbered = column_kinds.numbered_positions(candidates)
        if numbered and (candidates is not told or len(numbered) < len(told)):
            return numbered, 3, ["positions: three numbered columns of one name; please check"]
    raise DataError(
        f"no columns look like positions: {', '.join(names[:40])}",
        where=path,
        fix="name them m1_x, m1_y, m1_z, m2_x, ..., or write the entry by hand, see config/README.md",
    )


def _commands(
    kinds: Mapping[str, str | None], looked: Mapping[str, Any], path: Path, told: Sequence[str]
) -> tuple[list[str], list[str]]:
    """Columns of commands, those that a person says are `told` the robot among them, and what is to be checked."""
    commands = [*(name for name, kind in kinds.items() if kind == "command"), *told]
    if commands:
        return commands, []
    unknown = [name for name, kind in kinds.items() if kind is None]
    timeless = [name for name in unknown if column_kinds.rising([name], looked) is None]
    if unknown:
        return timeless or unknown, ["commands: all columns that look like nothing else; please check"]
    angles = [name for name, kind in kinds.items() if kind == "no position" and words_of(name) & column_kinds.TOLD]
    if angles:
        return angles, ["commands: columns that are angles or rates of what a robot is told by; please check"]
    text = {name: column[0] for name, column in looked.items() if len(column) and column.dtype == object}
    holds = "".join(f"; '{name}' holds text: '{str(cell)[:20]}'" for name, cell in [*text.items()][:4])
    raise DataError(
        f"no column looks like a command: {', '.join([*looked][:40])}{holds}",
        where=path,
        fix="name them u1, u2, ..., or name the file of commands, too, where a tracker wrote this one (make new-robot "
        "FILE=commands.csv POSITIONS=take.csv), or write the entry by hand, see config/README.md",
    )


def _told(unit: str, path: Path) -> str:
    """The unit that the file tells, checked: others than those of an entry are never taken for one of these."""
    if reason := reason_against(unit):
        raise DataError(f"positions in {unit}: {reason}", where=path, fix="bring them to one of these units")
    return unit


def _unit(names: Sequence[str], values: Array, path: Path, table: Table) -> tuple[str, str]:
    """The unit of the positions, and why."""
    said = {table.units[table.names.index(name)] for name in names} if table.units else set()
    told = {LENGTHS.get(unit.lower()) or unit for unit in said}
    if len(told) == 1 and (unit := told.pop()) not in ("", "-", "1", "%"):
        return _told(unit, path), f"position_unit: the row of units says {unit}"
    units = {unit_of(name) for name in names}
    if len(units - {None}) > 1:
        raise DataError(
            f"positions in different units: {', '.join(names)}", where=path, fix="bring all columns to one unit"
        )
    if None not in units:
        unit = str(units.pop())
        return _told(unit, path), f"position_unit: the columns' names say {unit}"
    extent = float(np.ptp(values, axis=0).max())
    if all(words_of(name) & PIXELS for name in names):
        return PX, "position_unit: the names say pixels, which stay pixels: no length is known of them; please check"
    unit = "m" if extent <= LARGEST_METRES else "mm"
    beside = next((name for name in table.names if words_of(name) & PIXELS), None)
    hint = "" if beside is None else f" ({PX} if these are pixels, as '{beside}' seems to be)"
    hint += " (cm is possible, too)" * (LARGEST_METRES < extent <= NARROW_MM)
    return unit, f"position_unit: guessed from the width of the workspace, {extent:.3g}; please check{hint}"
