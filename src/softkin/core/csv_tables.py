"""Tables as CSV: what is infinite is a word in the file, as everywhere a person reads, and a number again when read."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.files import replacing

#: How a cell of a CSV file says that a number has no bound.
INFINITE = "infinite"
MINUS_INFINITE = "-infinite"
_NUMBERS = {INFINITE: np.inf, MINUS_INFINITE: -np.inf}


def write_csv(path: str | os.PathLike[str], frame: pd.DataFrame) -> None:
    """Write a table in one step, without its index; infinite numbers as words, missing ones as empty cells."""
    with replacing(path) as temporary:
        in_words(frame).to_csv(temporary, index=False)


def csv_of(frame: pd.DataFrame) -> str:
    """The text that `write_csv` writes."""
    return text_of(in_words(frame))


def text_of(worded: pd.DataFrame) -> str:
    """The text that `write_csv` writes of a table, or of rows of one, that is `in_words` already."""
    return str(worded.to_csv(index=False))


def in_words(frame: pd.DataFrame) -> pd.DataFrame:
    """The table with `infinite` and `-infinite` in the cells of infinite numbers; all others are as they were."""
    words: dict[str, pd.Series] = {}
    for name in frame.select_dtypes(exclude=["integer", "bool"]).columns:
        endless = _endless(frame[name])
        if endless.any():
            cells = frame[name].astype(object)
            words[name] = cells.where(~endless, cells.map({number: word for word, number in _NUMBERS.items()}))
    return frame.assign(**words) if words else frame


def _endless(column: pd.Series) -> pd.Series:
    """Which cells are infinite numbers; texts and missing ones are not."""
    if pd.api.types.is_float_dtype(column):
        return np.isinf(column)
    return column.map(lambda cell: isinstance(cell, float) and bool(np.isinf(cell))).astype(bool)


def read_csv(path: str | os.PathLike[str], **options: Any) -> pd.DataFrame:
    """Read a table that softkin wrote: columns of numbers with the words of infinite ones are numbers again.

    Parameters:
        path: a CSV file with a header.
        options: as of `pandas.read_csv`. Columns whose type `dtype` gives keep it, words and all.

    Raises:
        EmptyDataError: the file is empty, as `pandas.read_csv` says it.
    """
    frame = pd.read_csv(path, low_memory=False, **options)
    typed = options.get("dtype", {})
    if not isinstance(typed, Mapping):
        return frame
    for name in frame.select_dtypes(exclude=["number", "bool"]).columns.difference(list(typed)):
        if frame[name].isin(_NUMBERS).any():
            frame[name] = _as_numbers(frame[name])
    return frame


def _as_numbers(column: pd.Series) -> pd.Series:
    """The column as numbers; as it is where a cell is another text."""
    cells = column.astype(object).map(lambda cell: _NUMBERS.get(cell, cell))
    try:
        return cells.astype(np.float64)
    except (TypeError, ValueError):
        return column
