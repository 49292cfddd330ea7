"""Which cells of a column of labels or times hold nothing, whatever kind of file they stand in."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError


def lacks_value(column: NDArray[Any]) -> NDArray[np.bool_]:
    """Mask (n_rows,) of the cells of a column (n_rows,) that hold nothing: None, NaN, or text that is blank."""
    import pandas as pd

    lacking: NDArray[np.bool_] = np.asarray(pd.isna(column))
    if column.dtype != object:
        return lacking
    is_blank = np.array([isinstance(cell, str) and not cell.strip() for cell in column], dtype=bool)
    return np.asarray(lacking | is_blank)


def check_whole(name: str, column: NDArray[Any], what: str, place: Callable[[int], str]) -> None:
    """No cell of the column `name` lacks its value.

    Parameters:
        name: of the column.
        column: its values (n_rows,).
        what: what the value of a row is, in words.
        place: row number -> where the row stands in the file.

    Raises:
        DataError: a cell holds nothing; names the first.
    """
    lacking = lacks_value(column)
    if lacking.any():
        raise DataError(
            f"no value, so the {what} of the row is unknown",
            where=f"{place(int(np.argmax(lacking)))}, column '{name}'",
            fix="fill the cell or delete the row",
        )
