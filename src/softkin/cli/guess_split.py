"""Guess how the rows of a robot's own table are split, and which columns tell their order and session."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.cli import column_kinds
from softkin.core.errors import DataError
from softkin.core.samples import SUBSETS, Array
from softkin.data import split
from softkin.data.readers.memory_table import Table
from softkin.data.recordings import check_placed, recording_of

#: Parts of a column's name that say one power-on of the robot.
SESSION = re.compile(r"session|trial|run")
#: A time that starts again does so at most in this share of rows; in more, rows are in no order.
RESTARTS = 0.05
Kinds = Mapping[str, str | None]


def when_recorded(table: Table, kinds: Kinds) -> tuple[dict[str, str], list[str]]:
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
    if session is None and (starts := restarts_of(by["order"])):
        return {}, [
            f"order, session: left out, since '{order}' starts again at {table.place(starts[0])}, as when the robot is "
            "switched on again: add a column that numbers the sessions, or put them in files of their own"
        ]
    return named, [f"{', '.join(named)}: guessed from the names of columns, so that memory can be found; please check"]


def restarts_of(times: NDArray[Any]) -> list[int]:
    """Rows at which numbers (n_rows,) of time begin anew, by at least half of what had passed; none of rows that are in
    no order.
    """
    try:
        values = np.asarray(times, dtype=np.float64)
    except ValueError:
        return []
    falls = np.flatnonzero(np.diff(values) < 0) + 1
    if not 0 < len(falls) <= max(1.0, RESTARTS * len(values)):
        return []
    starts = [0, *falls[:-1].tolist()]
    is_far = [
        values[row - 1] - values[row] >= 0.5 * (values[row - 1] - values[start])
        for start, row in zip(starts, falls.tolist(), strict=True)
    ]
    return falls.tolist() if all(is_far) else []


def split_of(table: Table, kinds: Kinds, when: Mapping[str, str], are_trials: bool) -> tuple[dict[str, Any], str]:
    """The options of the split, and why; `when` are columns of order and session, and where the files `are_trials` the
    session is that of each.
    """
    by_kind = {kind: name for name, kind in reversed(list(kinds.items()))}
    if name := by_kind.get("subset"):
        _, (column,) = table.read([], [table.names.index(name)])
        if {str(value).strip() for value in column} <= set(split.SPELLINGS):
            return {"method": "column", "column": name}, f"split: '{name}' names the subsets"
    if are_trials and when.get("session"):
        return {"method": "session"}, "split: by session, since the files are trials; the last is the test"
    if name := by_kind.get("group"):
        _, (column,) = table.read([], [table.names.index(name)])
        n_groups = len({str(value).strip() for value in column})
        if n_groups >= len(SUBSETS):
            return {"method": "group", "column": name}, f"split: by group, since there is a column '{name}'"
        if n_groups > 1 and when.get("session") == name:
            why = f"split: by session, since '{name}' tells {n_groups}, too few to draw from; the last is the test"
            return {"method": "session"}, why
    if name := by_kind.get("time"):
        _, (column,) = table.read([], [table.names.index(name)])
        if restarts_of(column):
            why = f"split: by stretches in the order of the file, since '{name}' starts again in it; please check"
            return {"method": "time"}, why
        return {"method": "time", "column": name}, f"split: by time, since there is a column '{name}'"
    return {"method": "random"}, "split: at random, rows of the same command together"


def of_recording(
    inputs: Array, commands: Sequence[str], kinds: Kinds, looked: Mapping[str, NDArray[Any]]
) -> tuple[dict[str, str], dict[str, Any], str] | None:
    """Order, split and why of rows whose commands `inputs` (n_rows, n_commands) follow each other though no column is
    called a time; None where rows in turn are not alike.
    """
    if not column_kinds.are_alike(inputs):
        return None
    others = {name: kind for name, kind in kinds.items() if name not in commands}
    rising = column_kinds.running_number(others, looked) or column_kinds.rising(list(others), looked)
    if rising is not None:
        what = "is a running number" if column_kinds.is_running(looked[rising]) else "grows from row to row"
        why = f"order, split: '{rising}' {what} and rows in turn are alike; please check"
        return {"order": rising}, {"method": "later"}, why
    why = (
        "split: by stretches in the order of the file, since rows in turn are alike, as of a recording, and no column "
        "tells their time; with one as `order` memory can be found; please check"
    )
    return {}, {"method": "time"}, why
