"""The recording of a dataset: order and session of its rows, checked, and what the robot may remember at each.

They stand in columns of the file, or in a table of their own beside a published file: subset, row (0-based, within the
subset), a column of the order and perhaps one of the session.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.recording import CommandMemory, Recording, Whole, gaps
from softkin.core.samples import SUBSETS, Array, Samples
from softkin.data.missing_values import lacks_value
from softkin.data.times import times

logger = logging.getLogger("softkin")

#: Larger whole numbers are times in seconds or less, and no count of poses.
LARGEST_ORDER = 1e9
FIX_ORDER = "give each row of a session its own order, or leave `order` out of the entry"


def recording_of(
    commands: Array,
    order: NDArray[Any] | None,
    session: NDArray[Any] | None,
    place: Callable[[int], str],
) -> Recording:
    """The recording of all rows of a dataset, their memory included.

    Whole numbers of order that count rows stay as they are, so that gaps stay visible; times, of a clock in whole
    milliseconds too, become ranks from 1, of all rows. Where
    the order starts again in each session, sessions follow each other as in the file. A row whose command, order or
    session is missing is a hole: nothing is known of what it left behind, so memory begins at rest after it.

    Parameters:
        commands: (n_rows, n_commands), NaN where it is missing.
        order: numbers or dates (n_rows,); None: rows are in the order of the file.
        session: labels (n_rows,); None: one session.
        place: row number -> where the row stands in the file, for messages.

    Raises:
        DataError: two rows of a session have the same order, or rows of another session stand between those of one.
    """
    import pandas as pd

    n_rows = len(commands)
    is_placed = ~np.any(
        [np.zeros(n_rows, bool), *(lacks_value(by) for by in (order, session) if by is not None)], axis=0
    )
    rows = np.flatnonzero(is_placed)

    def placed(row: int) -> str:
        return place(int(rows[row]))

    when = rows + 1 if order is None else times("order", order[rows], placed)
    labels = np.zeros(len(rows), dtype=np.int64)
    if session is not None:
        labels = np.asarray(pd.factorize(session[rows])[0], np.int64)
    _check_unique(when, labels, placed)
    if len(np.unique(when)) < len(rows) or _starts_again(when, labels):
        in_time = np.lexsort([when, labels])
        number = np.arange(1, len(rows) + 1)
    else:
        in_time = np.argsort(when, kind="stable")
        counts = bool((when == np.round(when)).all()) and bool((np.abs(when) < LARGEST_ORDER).all())
        counts = counts and bool(np.median(np.diff(when[in_time], prepend=when.min() - 1)) <= 1)  # else a clock in ms
        number = when[in_time].astype(np.int64) if counts else np.arange(1, len(rows) + 1)
    numbered, numbers = np.zeros(n_rows, dtype=np.int64), np.zeros(n_rows, dtype=np.int64)
    numbered[rows[in_time]] = number
    numbers[rows] = _sessions(labels, in_time, placed)
    is_hole = np.asarray(np.isnan(commands).any(axis=1))
    is_after = is_hole | np.r_[False, ~is_placed[:-1]]
    robot = CommandMemory.of(commands[~is_hole])
    memory = _memory(robot, commands, rows[in_time], numbers, is_hole, is_after)
    return Recording(numbered, numbers, memory, robot)


def check_placed(recording: Recording, place: Callable[[int], str]) -> None:
    """Each row of the recording has its order and its session; `place` as of `recording_of`.

    Raises:
        DataError: a row lacks one; names the first.
    """
    lacking = np.flatnonzero(recording.session == 0)
    if len(lacking):
        raise DataError(
            "no order or no session, so what the robot remembers there is unknown"
            + (f" (rows without: {len(lacking)})" if len(lacking) > 1 else ""),
            where=f"{place(int(lacking[0]))}, `order`, `session`",
            fix="fill the cell or delete the row",
        )


def _memory(
    robot: CommandMemory,
    commands: Array,
    in_time: NDArray[np.intp],
    sessions: Whole,
    is_hole: NDArray[np.bool_],
    is_after: NDArray[np.bool_],
) -> Array:
    """Memory (n_rows, n_memory) along the rows `in_time`, which begins anew with each session and after each hole."""
    memory = np.full((len(commands), len(robot.start())), np.nan)
    begins = np.r_[True, np.diff(sessions[in_time]) != 0] | is_after[in_time]
    begins[1:] |= is_hole[in_time[:-1]]
    for stretch in np.split(in_time, np.flatnonzero(begins)[1:]):
        known = stretch[~is_hole[stretch]]
        if len(known):
            memory[known] = robot.along(commands[known])
    return memory


def _starts_again(when: NDArray[Any], labels: Whole) -> bool:
    """Whether sessions stand one below the other, each in the order of time, and their times overlap."""
    starts = np.flatnonzero(np.r_[True, np.diff(labels) != 0])
    if len(starts) == 1 or len(starts) > len(np.unique(labels)):
        return False
    within = np.delete(np.diff(when), starts[1:] - 1)
    first, last = when[starts], when[np.r_[starts[1:] - 1, len(when) - 1]]
    by_start = np.argsort(first)
    return bool((within > 0).all()) and bool((first[by_start][1:] <= last[by_start][:-1]).any())


def _check_unique(when: NDArray[Any], labels: Whole, place: Callable[[int], str]) -> None:
    import pandas as pd

    twice = pd.DataFrame({"session": labels, "order": when}).duplicated().to_numpy()
    if twice.any():
        row = int(np.argmax(twice))
        first = int(np.argmax((when == when[row]) & (labels == labels[row])))
        raise DataError(f"the same order as {place(first)}: {when[row]}", where=f"{place(row)}, `order`", fix=FIX_ORDER)


def _sessions(labels: Whole, in_time: NDArray[np.intp], place: Callable[[int], str]) -> Whole:
    """Sessions numbered from 1 in the order of time, each in one piece."""
    import pandas as pd

    ordered = labels[in_time]
    starts = np.flatnonzero(np.r_[True, np.diff(ordered) != 0])
    if len(starts) > len(np.unique(labels)):
        seen = pd.Series(ordered[starts]).duplicated().to_numpy()
        row = int(in_time[starts[np.argmax(seen)]])
        raise DataError(
            "its session began before, and rows of another session stand between",
            where=f"{place(row)}, `session`",
            fix="give each power-on of the robot its own session, or correct `order`",
        )
    numbers = np.empty(len(starts), dtype=np.int64)
    numbers[ordered[starts]] = np.arange(1, len(starts) + 1)
    return np.asarray(numbers[labels])


def with_order_table(samples: Mapping[str, Samples], path: str | Path, source: Mapping[str, Any]) -> dict[str, Samples]:
    """The samples of all subsets with their recording, from the table at `path` that the entry `source` names.

    Raises:
        DataError: the table does not name each row once, or its orders or sessions cannot be used.
    """
    import pandas as pd

    column, where = source["order"]["column"], f"file {path}"
    frame = pd.read_csv(path)
    names = ["subset", "row", column, *([source["session"]] if "session" in source else [])]
    missing = [name for name in names if name not in frame]
    if missing:
        raise DataError(f"no column '{missing[0]}'", where=where, fix="correct `order` and `session` of the entry")
    rows = pd.MultiIndex.from_tuples([(name, row) for name, part in samples.items() for row in range(len(part))])
    index = pd.MultiIndex.from_frame(frame[["subset", "row"]])
    if len(frame) != len(rows) or not index.is_unique or not index.isin(rows).all():
        raise DataError(
            f"{len(frame)} rows that are not the {len(rows)} of the dataset, each once",
            where=where,
            fix="name each row by its subset and its number from 0, or leave `order` out of the entry",
        )
    frame = frame.set_axis(index).loc[rows]
    commands = np.concatenate([part.commands for part in samples.values()])
    session = frame[source["session"]].to_numpy() if "session" in source else None

    def place(row: int) -> str:
        return f"subset {rows[row][0]}, row {rows[row][1]}"

    try:
        recording = recording_of(commands, frame[column].to_numpy(), session, place)
        check_placed(recording, place)
    except DataError as error:
        raise error.within(where) from error
    ends = np.cumsum([len(part) for part in samples.values()])[:-1]
    places = dict(zip(samples, np.split(np.arange(len(commands)), ends), strict=True))
    return {name: replace(part, recording=recording.take(places[name])) for name, part in samples.items()}


def description(samples: Mapping[str, Samples]) -> dict[str, Any] | None:
    """What a dataset's description says of its recording: rows of each session and poses missing in its order; None
    without one. The log warns of gaps.
    """
    recordings = [samples[subset].recording for subset in SUBSETS]
    known = [recording for recording in recordings if recording is not None]
    if not known:
        return None
    order, session = (np.concatenate(parts) for parts in zip(*((r.order, r.session) for r in known), strict=True))
    missing = gaps(order)
    if missing:
        logger.warning(
            "%d poses are missing from the recording's order: where their commands are missing, too, what they left "
            "behind in the robot is unknown",
            missing,
        )
    numbers, counts = np.unique(session, return_counts=True)
    rows = {str(number): int(count) for number, count in zip(numbers, counts, strict=True)}
    return {"rows_of_session": rows, "missing_poses": missing}
