from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import TRAIN, Array, Samples
from softkin.data.marker_order import is_swapped, orders_of, relabelled
from tests.unit.data.audit.clean_robot import clean_robot


@pytest.fixture(scope="module")
def arm() -> dict[str, Samples]:
    return clean_robot(300, n_commands=2, n_markers=4, seed=1)


def test_a_marker_that_is_lost_is_not_mended(arm: dict[str, Samples]) -> None:
    lost = arm[TRAIN].positions.copy()
    lost[5, :3] += 500.0
    assert (orders_of(lost, arm[TRAIN].positions) == np.arange(4)).all()


def test_the_order_says_which_marker_stands_where(arm: dict[str, Samples]) -> None:
    positions: Array = arm[TRAIN].positions.copy()
    positions[7] = positions[7].reshape(4, 3)[[0, 2, 1, 3]].ravel()
    orders = orders_of(positions, arm[TRAIN].positions)
    assert orders[7].tolist() == [0, 2, 1, 3]
    assert np.flatnonzero(is_swapped(orders)).tolist() == [7]


def test_all_subsets_are_mended_by_what_train_shows(arm: dict[str, Samples]) -> None:
    turned = {name: rows.positions.reshape(len(rows), 4, 3)[:, [1, 0, 2, 3]] for name, rows in arm.items()}
    test = Samples(arm["test"].commands, turned["test"].reshape(len(arm["test"]), -1))
    mended, counts = relabelled({**arm, "test": test})
    assert counts == {"train": 0, "validation": 0, "test": len(test), "extrapolation": 0}
    np.testing.assert_array_equal(mended["test"].positions, arm["test"].positions)


@pytest.mark.parametrize("n_markers", [1, 2])
def test_one_or_two_markers_have_no_other_order(n_markers: int) -> None:
    positions = np.random.default_rng(0).normal(size=(40, 3 * n_markers))
    assert not is_swapped(orders_of(positions, positions)).any()


def test_markers_that_stand_on_each_other_are_left_alone() -> None:
    positions = np.ones((5, 9))
    assert not is_swapped(orders_of(positions, positions)).any()
