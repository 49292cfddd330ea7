from __future__ import annotations

import numpy as np

from softkin.core.metrics.left_out import (
    point_metrics_without_each_row,
    r2_without_each_coordinate,
    without_each_row,
)
from softkin.core.metrics.point import point_metrics, r2

RNG = np.random.default_rng(0)
TRUE = RNG.normal(size=(12, 6)) * 30
PREDICTED = TRUE + RNG.normal(size=TRUE.shape)
MOVING = np.array([False] * 3 + [True] * 3)


def test_each_row_is_left_out_in_turn() -> None:
    found = point_metrics_without_each_row(TRUE, PREDICTED, MOVING)
    for row in range(len(TRUE)):
        rest = np.arange(len(TRUE)) != row
        expected = point_metrics(TRUE[rest], PREDICTED[rest], MOVING)
        for name, values in found.items():
            np.testing.assert_allclose(values[row], expected[name], rtol=1e-12, err_msg=name)


def test_a_row_that_is_far_larger_takes_no_digits_from_the_others() -> None:
    values = np.full((100, 1), 1e-12)
    values[40] = 1e12
    np.testing.assert_allclose(without_each_row(values)[40], 1e-12, rtol=1e-9)


def test_each_coordinate_is_left_out_of_r2() -> None:
    found = r2_without_each_coordinate(TRUE, PREDICTED)
    for place in range(TRUE.shape[1]):
        rest = np.arange(TRUE.shape[1]) != place
        np.testing.assert_allclose(found[place], r2(TRUE[:, rest], PREDICTED[:, rest]), rtol=1e-12)
