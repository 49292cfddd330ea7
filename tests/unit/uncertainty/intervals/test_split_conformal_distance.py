from __future__ import annotations

from typing import Literal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from softkin.uncertainty.intervals import split_conformal_distance
from softkin.uncertainty.intervals.split_conformal_distance import LEAST_DIFFICULTY, distances, intervals
from tests.unit.uncertainty.conftest import LEVELS, rank, spread_calibration


@pytest.mark.parametrize("n", [88, 140])
def test_the_half_width_is_proportional_to_the_difficulty(n: int) -> None:
    data = spread_calibration(n)
    known, new = distances(data.train_commands, [data.calibration_commands, data.new_commands])
    scores = np.sort(np.abs(data.truth - data.calibration) / known[:, None], axis=0)
    for level, bounds in zip(LEVELS, intervals(data, LEVELS), strict=True):
        half = scores[rank(n, level) - 1] * new[:, None]
        np.testing.assert_allclose(bounds, np.stack([data.new - half, data.new + half], axis=-1), atol=1e-10)


def test_the_difficulty_grows_with_the_distance_without_end() -> None:
    """crepes' own estimate stops at the edge of the training box."""
    train = np.random.default_rng(0).uniform(-1, 1, (200, 2))
    (difficulty,) = distances(train, [np.array([[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [8.0, 0.0]])])
    assert (np.diff(difficulty) > 4).all()
    copies = np.repeat(train[:10], 20, axis=0)
    (same,) = distances(copies, [copies[:1]])
    assert same.tolist() == [LEAST_DIFFICULTY]


def test_commands_of_many_dimensions_take_no_more_corners_than_those_of_ten() -> None:
    train = np.random.default_rng(0).uniform(-1, 1, (30, 40))
    near, far = distances(train, [train[:3], 5 * train[:3]])
    assert (far > near).all()


@pytest.mark.parametrize("order", ["C", "F"])
def test_of_the_same_commands_it_is_computed_once_and_is_the_same_to_the_bit(order: Literal["C", "F"]) -> None:
    rng = np.random.default_rng(3)
    train, new = (np.asarray(rng.uniform(-1, 1, (n, 3)), order=order) for n in (80, 20))
    (first,) = distances(train, [new])
    known = split_conformal_distance._difficulty.cache_info().hits
    (second,) = distances(train.copy(order), [new.copy(order)])
    assert split_conformal_distance._difficulty.cache_info().hits == known + 1
    numbers, finder = split_conformal_distance._measured(train)
    rows = (new - numbers["mean"]) / numbers["scale"]
    within = np.minimum(finder.kneighbors(rows)[0].mean(axis=1), numbers["emptiest"])
    is_in_box = ((rows >= numbers["low"]) & (rows <= numbers["high"])).all(axis=1)
    assert is_in_box.any()
    np.testing.assert_array_equal(first, second)
    np.testing.assert_array_equal(first[is_in_box], (LEAST_DIFFICULTY + within / numbers["unit"])[is_in_box])
    assert not np.array_equal(distances(train + 1, [new])[0], first)


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 50),
    n_commands=st.integers(1, 4),
    direction=st.lists(st.floats(-1, 1), min_size=4, max_size=4),
)
def test_the_difficulty_never_shrinks_along_a_ray_that_leaves_the_box(
    seed: int, n_commands: int, direction: list[float]
) -> None:
    rng = np.random.default_rng(seed)
    train = rng.uniform(-1, 1, (60, n_commands)) ** 3 * [1.0, 10.0, 100.0, 1000.0][:n_commands]
    heading = np.array(direction[:n_commands]) + 1e-3
    start = rng.uniform(train.min(axis=0), train.max(axis=0))
    ray = start + np.linspace(0, 8, 200)[:, None] * heading * train.std(axis=0)
    (difficulty,) = distances(train, [ray])
    in_box = ((ray >= train.min(axis=0)) & (ray <= train.max(axis=0))).all(axis=1)
    last = int(np.flatnonzero(in_box)[-1])
    assert (np.diff(difficulty[last:]) >= -1e-9).all()
