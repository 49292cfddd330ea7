from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from softkin.core.samples import Array
from softkin.uncertainty.cells import FAR, MOST_LOOKED_AT, NEAR, UNKNOWN, grid_of


def unasked(rows: Array) -> Array:
    raise AssertionError(len(rows))


@pytest.mark.parametrize(("n_commands", "share_told"), [(1, 0.95), (2, 0.85), (3, 0.4), (4, 0.0)])
def test_what_a_cell_tells_is_so(n_commands: int, share_told: float) -> None:
    rng = np.random.default_rng(0)
    tree = cKDTree(rng.uniform(-1, 1, (150, n_commands)))
    gap = float(tree.query(tree.data, k=2)[0][:, 1].max())
    grid = grid_of(tree.data, gap, lambda rows: tree.query(rows)[0])
    assert grid is not None
    rows = np.vstack([rng.uniform(-2, 2, (4000, n_commands)), rng.uniform(-1e100, 1e100, (50, n_commands)), tree.data])
    told, is_far = grid.told(rows), tree.query(rows)[0] > gap
    assert is_far[told == FAR].all()
    assert not is_far[told == NEAR].any()
    assert (told != UNKNOWN).mean() >= share_told
    assert (told[-150:] == NEAR).all()


def test_many_cells_tell_of_those_alone_that_hold_a_point() -> None:
    points = np.array([[0.0, 0.0], [1000.0, 1000.0], [0.0, 500.0]])
    grid = grid_of(points, 2.0, unasked)
    assert grid is not None
    assert grid.cells.size > MOST_LOOKED_AT
    np.testing.assert_array_equal(np.unique(grid.told(np.vstack([points, [[9.0, 9.0]]]))), [UNKNOWN, NEAR])


def test_without_a_gap_or_with_too_many_cells_there_is_no_grid() -> None:
    points = np.random.default_rng(0).uniform(-1, 1, (9, 12))
    assert grid_of(points, 0.0, unasked) is None
    assert grid_of(points, 0.1, unasked) is None
