from __future__ import annotations

import numpy as np

from softkin.core.samples import command_columns, coordinate_columns, informative_coordinates


def test_columns_are_named_as_the_design_says() -> None:
    assert command_columns(2) == ["u1", "u2"]
    assert coordinate_columns(2) == ["m1_x", "m1_y", "m1_z", "m2_x", "m2_y", "m2_z"]


def test_a_coordinate_that_only_trembles_is_not_informative() -> None:
    rng = np.random.default_rng(0)
    positions = np.column_stack([np.full(9, 5.0), 1e-37 * rng.standard_normal(9), rng.standard_normal(9)])
    assert informative_coordinates(positions).tolist() == [False, False, True]
