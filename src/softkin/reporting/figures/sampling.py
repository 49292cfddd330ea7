"""Rows that are drawn: of a subset of very many, a sample."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from softkin.reporting.figures.spec import DatasetResults

#: More marks than these hide each other, and take memory and time.
MOST_ROWS = 4000


def drawn_rows(n_rows: int, kept: ArrayLike = ()) -> NDArray[np.intp]:
    """Numbers of the rows of a subset that are drawn, ascending: all of up to `MOST_ROWS` rows.

    Of more it is a random sample of `MOST_ROWS`, the same each time, and the rows that are to be `kept` in any case.
    """
    if n_rows <= MOST_ROWS:
        return np.arange(n_rows)
    sample = np.random.default_rng(0).choice(n_rows, MOST_ROWS, replace=False)
    return np.union1d(sample, np.asarray(kept, dtype=np.intp))


def evenly_spaced(n_rows: int) -> NDArray[np.intp]:
    """Numbers of `MOST_ROWS` rows from the first to the last, ascending, or of all: for sorted rows."""
    return np.unique(np.linspace(0, n_rows - 1, min(n_rows, MOST_ROWS)).round().astype(np.intp))


def sample_notes(results: DatasetResults, subsets: Collection[str]) -> list[str]:
    """A sentence for each of these subsets of which only a sample is drawn."""
    if not subsets:
        return []
    counts = pd.read_parquet(results.table, columns=["subset"])["subset"].value_counts()
    return [
        f"{subset}: {MOST_ROWS} of {counts[subset]} rows are drawn, a random sample"
        for subset in subsets
        if counts[subset] > MOST_ROWS
    ]
