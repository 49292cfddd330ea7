from __future__ import annotations

import numpy as np

from softkin.core.samples import (
    CONSTANT_RANGE_MM,
    Samples,
    command_columns,
    coordinate_columns,
    informative_coordinates,
    measured_coordinates,
)


def test_columns_are_numbered_from_one_and_coordinates_go_marker_by_marker() -> None:
    assert command_columns(2) == ["u1", "u2"]
    assert coordinate_columns(2) == ["m1_x", "m1_y", "m1_z", "m2_x", "m2_y", "m2_z"]


def test_a_near_constant_coordinate_does_not_move() -> None:
    rng = np.random.default_rng(0)
    positions = np.column_stack([np.full(9, 5.0), 1e-37 * rng.standard_normal(9), rng.standard_normal(9)])
    assert informative_coordinates(positions).tolist() == [False, False, True]


def test_a_range_of_the_limit_is_constant_and_any_larger_one_is_not() -> None:
    steps = np.array([[0.0], [CONSTANT_RANGE_MM], [np.nextafter(CONSTANT_RANGE_MM, 1)]])
    assert not informative_coordinates(steps[[0, 1]]).any()
    assert informative_coordinates(steps[[0, 2]]).all()


def test_the_length_of_samples_is_their_number_of_rows() -> None:
    assert len(Samples(np.zeros((4, 2)), np.zeros((4, 3)))) == 4


def test_averages_are_over_what_was_measured() -> None:
    planar = np.array([[1.0, 2.0, 0.0, 3.0, 4.0, 0.0], [2.0, 2.0, 0.0, 3.0, 5.0, 0.0]])
    assert measured_coordinates(planar).tolist() == [True, True, False] * 2
    planar[1, 5] = 1e-9
    assert measured_coordinates(planar).all()
