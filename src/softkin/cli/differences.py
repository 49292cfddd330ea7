"""What differs between a stored file and the same file made once more, in a sentence."""

from __future__ import annotations

from itertools import takewhile
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.csv_tables import read_csv
from softkin.core.escaping import one_line

#: Numbers that differ by less, relative to their size, are the same.
TOLERANCE = 1e-9
#: Characters of a line or cell that are shown, and of these at most so many before the first that differs.
SHOWN, BEFORE = 100, 30


def differences(
    path: Path, made: pd.DataFrame, tolerance: float = TOLERANCE, *, all_columns: bool = False
) -> list[str]:
    """What differs between the table at `path` and what it was `made` from: the first cell, or what is missing.

    Parameters:
        path: a CSV file.
        made: the table as it should be.
        tolerance: numbers that differ by less, relative to their size, are the same.
        all_columns: whether the file may have no columns besides.
    """
    stored = read_csv(path)
    if len(stored) != len(made):
        return [f"{path} has {len(stored)} rows, and its sources give {len(made)}"]
    missing = [name for name in made if name not in stored]
    if missing:
        return [f"{path} has no column {missing[0]}"]
    more = [name for name in stored if name not in made]
    if all_columns and more:
        return [f"{path} has a column {more[0]}, which its sources do not give"]
    for name in made:
        places = np.flatnonzero(differ(stored[name], made[name], tolerance))
        if len(places):
            row = int(places[0])
            old, new = _where_they_part(str(stored[name].iloc[row]), str(made[name].iloc[row]))
            return [f"{path}, row {row + 1}, column {name}: {old} stands there, and its sources give {new}"]
    return []


def differ(old: pd.Series, new: pd.Series, tolerance: float = TOLERANCE) -> NDArray[np.bool_]:
    """Which cells of two columns differ: as numbers where all are, else as texts."""
    try:
        numbers = old.to_numpy(np.float64, na_value=np.nan), new.to_numpy(np.float64, na_value=np.nan)
    except (TypeError, ValueError):
        return np.asarray(old.astype(object).map(str).to_numpy() != new.astype(object).map(str).to_numpy())
    return np.asarray(~np.isclose(*numbers, rtol=tolerance, atol=0.0, equal_nan=True))


def other_line(stored: Path, made: Path) -> str:
    """The first line of a text that is another than in the one that was made; of other files, that they differ."""
    try:
        lines = [path.read_text(encoding="utf-8").splitlines() for path in (stored, made)]
    except UnicodeDecodeError:
        return f"{stored} is not what its sources give"
    most = max(map(len, lines))
    old, new = ([*text, *[""] * (most - len(text))] for text in lines)
    for number, pair in enumerate(zip(old, new, strict=True), start=1):
        if pair[0] != pair[1]:
            stands, given = _where_they_part(*pair)
            return f"{stored}, line {number}: '{stands}' stands there, and its sources give '{given}'"
    return f"{stored} ends otherwise than its sources give"


def _where_they_part(old: str, new: str) -> tuple[str, str]:
    """Two texts that differ, each in one line; of long ones the characters around the first that differs."""
    old, new = one_line(old), one_line(new)
    if max(len(old), len(new)) <= SHOWN:
        return old, new
    same = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(old, new, strict=False)))
    start = max(0, same - BEFORE)
    parts = [text[start : start + SHOWN] for text in (old, new)]
    ends = ["..." if len(text) > start + SHOWN else "" for text in (old, new)]
    before = "..." if start else ""
    return before + parts[0] + ends[0], before + parts[1] + ends[1]
