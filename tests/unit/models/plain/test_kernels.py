from __future__ import annotations

import numpy as np

from softkin.models.plain.kernels import BLOCK, SHAPES, blockwise, prior


def test_a_triangle_is_solved_in_blocks() -> None:
    rng = np.random.default_rng(0)
    lower = np.tril(rng.normal(size=(2 * BLOCK + 5, 2 * BLOCK + 5))) / 20 + 3 * np.eye(2 * BLOCK + 5)
    right = rng.normal(size=(len(lower), 2))
    np.testing.assert_allclose(lower @ blockwise(lower)(right), right, atol=1e-12)


def test_a_row_with_itself_is_its_prior() -> None:
    rows = np.random.default_rng(0).normal(size=(4, 2))
    term = {"constant": 2.0, "lengths": np.ones(2), "rate": 0.5, "offset": 0.3, "power": 2}
    for shape, kernel in SHAPES.items():
        one = term | {"shape": shape}
        np.testing.assert_allclose(np.diag(kernel(one, rows)(rows)), prior(one, rows))
