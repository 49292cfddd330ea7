"""Intervals and quantiles as tables, and back."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from softkin.core.samples import Array
from softkin.core.samples import coordinate_columns as coordinates_of


def bounds_frame(bounds: Array, subset: str, confidence_level: float) -> pd.DataFrame:
    """(n_rows, n_coordinates, 2) as a table: subset, confidence_level, lower_m1_x.., upper_m1_x.. (mm)."""
    names = coordinates_of(bounds.shape[1] // 3)
    columns = [f"{bound}_{name}" for bound in ("lower", "upper") for name in names]
    frame = pd.DataFrame(np.hstack([bounds[..., 0], bounds[..., 1]]), columns=columns)
    frame.insert(0, "subset", subset)
    frame.insert(1, "confidence_level", confidence_level)
    return frame


def read_bounds(frame: pd.DataFrame, subset: str, confidence_levels: Sequence[float]) -> Array:
    """The inverse of `bounds_frame`: (n_levels, n_rows, n_coordinates, 2) in mm."""
    levels = []
    for level in confidence_levels:
        rows = frame[(frame["subset"] == subset) & (frame["confidence_level"] == level)]
        lower, upper = (rows.filter(regex=f"^{bound}_").to_numpy() for bound in ("lower", "upper"))
        levels.append(np.stack([lower, upper], axis=-1))
    return np.stack(levels)
