from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import bounds_frame, read_bounds

LEVELS = (0.8, 0.9)


def bounds(subset: str, level: float, n_rows: int = 4) -> np.ndarray:
    """Bounds (n_rows, 6, 2) that differ with subset and level."""
    rng = np.random.default_rng([len(subset), round(100 * level)])
    return np.sort(rng.standard_normal((n_rows, 6, 2)), axis=-1)


def test_columns_are_named_by_bound_and_coordinate() -> None:
    frame = bounds_frame(bounds("test", 0.9), "test", 0.9)
    names = ["m1_x", "m1_y", "m1_z", "m2_x", "m2_y", "m2_z"]
    sides = [f"{side}_{name}" for side in ("lower", "upper") for name in names]
    assert list(frame.columns) == ["subset", "confidence_level", *sides]
    assert frame.loc[2, "lower_m2_x"] == bounds("test", 0.9)[2, 3, 0]
    assert frame.loc[2, "upper_m1_z"] == bounds("test", 0.9)[2, 2, 1]


def test_bounds_come_back_by_subset_and_level_to_the_bit() -> None:
    frame = pd.concat(
        [bounds_frame(bounds(subset, level), subset, level) for level in LEVELS for subset in ("test", "extrapolation")]
    )
    for subset in ("test", "extrapolation"):
        for levels in (LEVELS, LEVELS[::-1], LEVELS[1:]):
            expected = np.stack([bounds(subset, level) for level in levels])
            np.testing.assert_array_equal(read_bounds(frame, subset, levels), expected)


def test_subsets_need_not_have_equally_many_rows() -> None:
    frame = pd.concat([bounds_frame(bounds("test", 0.9), "test", 0.9), bounds_frame(bounds("x", 0.9, 9), "x", 0.9)])
    assert read_bounds(frame, "x", [0.9]).shape == (1, 9, 6, 2)


def test_levels_with_unequal_rows_are_refused() -> None:
    frame = pd.concat([bounds_frame(bounds("test", 0.9), "test", 0.9), bounds_frame(bounds("x", 0.8, 9), "test", 0.8)])
    with pytest.raises(ValueError, match="same shape"):
        read_bounds(frame, "test", LEVELS)
