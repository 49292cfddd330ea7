"""Intervals and quantiles as the tables that they are stored in, and back."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from softkin.core.samples import Array, coordinate_columns

#: Rows of a row group of a file of intervals. Runs follow each other in it, so that who reads one run finds it in a few
#: groups, by their statistics, and holds no more than these.
ROW_GROUP = 2**17


def bounds_frame(bounds: Array, subset: str, confidence_level: float) -> pd.DataFrame:
    """Bounds (n_rows, n_coordinates, 2) in mm as a table: subset, confidence_level, lower_m1_x, ..., upper_m1_x, ..."""
    names = coordinate_columns(bounds.shape[1] // 3)
    columns = [f"{bound}_{name}" for bound in ("lower", "upper") for name in names]
    frame = pd.DataFrame(np.hstack([bounds[..., 0], bounds[..., 1]]), columns=columns)
    frame.insert(0, "subset", subset)
    frame.insert(1, "confidence_level", confidence_level)
    return frame


def bounds_levels(frame: pd.DataFrame) -> list[float]:
    """The confidence levels, ascending, of tables made by `bounds_frame`."""
    return [float(level) for level in np.unique(frame["confidence_level"])]


def read_bounds(frame: pd.DataFrame, subset: str, confidence_levels: Sequence[float]) -> Array:
    """Bounds (n_levels, n_rows, n_coordinates, 2) in mm of one subset, out of tables made by `bounds_frame`."""
    columns = [name for name in frame.columns if name.startswith(("lower_", "upper_"))]
    is_upper = np.array([name.startswith("upper_") for name in columns], dtype=bool)
    of_subset = (frame["subset"] == subset).to_numpy(dtype=bool)
    numbers, level_of_row = frame[columns].to_numpy()[of_subset], frame["confidence_level"].to_numpy()[of_subset]
    levels = []
    for level in confidence_levels:
        rows = numbers[level_of_row == level]
        levels.append(np.stack([rows[:, ~is_upper], rows[:, is_upper]], axis=-1))
    return np.stack(levels)
