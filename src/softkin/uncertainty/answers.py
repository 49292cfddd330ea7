"""Answers of a calibrated model in the form of the call: an array, or a table where it was asked with one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.samples import Array


def like(asked: Any, values: Any, columns: str | Sequence[str]) -> Any:
    """Values as they are, or for a table as one with its index: a DataFrame of these columns, a Series of one name."""
    if not isinstance(asked, (pd.DataFrame, pd.Series)):
        return values
    index = index_of(asked)
    if isinstance(columns, str):
        return pd.Series(values, index=index, name=columns)
    return pd.DataFrame(values, index=index, columns=list(columns))


def bounds_frame(asked: Any, bounds: Array, levels: Sequence[float] | None, coordinates: Sequence[str]) -> pd.DataFrame:
    """Bounds (n_levels, n_rows, n_coordinates, 2) as a table with columns lower_m1_x, upper_m1_x, ...; where there are
    `levels`, below each of them.
    """
    columns = [f"{side}_{name}" for name in coordinates for side in ("lower", "upper")]
    frames = [pd.DataFrame(np.reshape(one, (len(one), -1)), index_of(asked), columns) for one in bounds]
    return frames[0] if levels is None else pd.concat(frames, axis=1, keys=levels)


def index_of(asked: pd.DataFrame | pd.Series) -> pd.Index:
    """The index of the rows of a table; a Series is one row."""
    return pd.Index([asked.name]) if isinstance(asked, pd.Series) else asked.index
