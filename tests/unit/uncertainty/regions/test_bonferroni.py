from __future__ import annotations

import numpy as np

from softkin.uncertainty.conformal import conformal_limit
from softkin.uncertainty.regions.bonferroni import METHOD
from tests.unit.uncertainty.regions.conftest import MARKERS, residuals


def test_it_is_a_box_of_intervals_at_a_sixth_of_the_miscoverage() -> None:
    rows = residuals(300, 0)
    region = METHOD.region(rows[:100], rows[100:], MARKERS, 0.9)
    limits = np.array([conformal_limit(np.abs(column), 1 - (1 - 0.9) / 6) for column in rows[100:].T])
    np.testing.assert_allclose(region.size_mm, np.exp(np.log(2 * limits).mean()))
    corner = (1 - 1e-9) * limits
    assert region.covers(corner[None]).all()
    for coordinate in range(6):
        assert not region.covers((corner + 2e-9 * limits * np.eye(6)[coordinate])[None]).any()


def test_a_coordinate_without_errors_does_not_hide_the_size_of_the_others() -> None:
    rows = residuals(300, 0) * [1, 1, 1, 1, 1, 0]
    assert METHOD.region(rows, rows, MARKERS, 0.9).size_mm > 0
