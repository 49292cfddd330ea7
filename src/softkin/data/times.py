"""Columns of time as people and programs write them, as numbers that sort alike."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError

#: A time of the day; a comma or a third colon may stand before its fraction.
_CLOCK = r"(\d{1,2}):(\d{2}):(\d{2})(?:[.,:](\d+))?"


def times(name: str, column: NDArray[Any], place: Callable[[int], str]) -> NDArray[Any]:
    """Numbers, ISO 8601 dates or times of the day, as text or numbers, as numbers (n_rows,) that sort alike: dates in a
    unit of pandas, times of the day in s since midnight.

    Parameters:
        name: of the column.
        column: its values (n_rows,).
        place: row number -> where the row stands in the file, for messages.

    Raises:
        DataError: a value is no time; names the first.
    """
    import pandas as pd

    if column.dtype != object:
        return column
    text = pd.Series(column).astype(str).str.strip()
    numbers = pd.to_numeric(text.str.replace(",", ".", regex=False), errors="coerce")
    if numbers.notna().all():
        return np.asarray(numbers.to_numpy(np.float64))
    clock = text.str.extract(f"^{_CLOCK}$")
    if clock[0].notna().all():
        hours, minutes, whole = (clock[part].astype(np.float64) for part in range(3))
        fraction = ("0." + clock[3].fillna("0")).astype(np.float64)
        return np.asarray((3600 * hours + 60 * minutes + whole + fraction).to_numpy(np.float64))
    dates = pd.to_datetime(text, format="ISO8601", errors="coerce", utc=True)
    if dates.notna().all():
        return np.asarray(dates.astype("int64").to_numpy())
    first = int(np.argmax((numbers.isna() & dates.isna() & clock[0].isna()).to_numpy()))
    raise DataError(
        f"'{column[first]}' is no time",
        where=f"{place(first)}, column '{name}'",
        fix="write all times as numbers (seconds), or all as dates like 2024-05-31T12:00:00.5",
    )
