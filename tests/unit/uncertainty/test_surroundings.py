from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.surroundings import FEWEST_ROWS, Surroundings


@pytest.mark.parametrize("n_commands", [1, 2, 3, 6, 17])
def test_cells_say_what_the_search_says(n_commands: int) -> None:
    rng = np.random.default_rng(0)
    train = rng.uniform(-1, 1, (120, n_commands))
    places = Surroundings(np.vstack([train, train[:5]]))
    new = rng.uniform(-1.3, 1.3, (2 * FEWEST_ROWS, n_commands))
    standard = (new - places.mean) / places.scale
    nearest = np.linalg.norm(standard[:, None] - places.points[None], axis=2).min(axis=1)
    far = places.are_far(new)
    np.testing.assert_array_equal(far, nearest > places.gap)
    np.testing.assert_array_equal(places.are_far(new[:9]), far[:9])
    assert not places.are_far(np.tile(train, (10, 1))).any()


def test_one_command_many_times_has_no_gap() -> None:
    places = Surroundings(np.tile([[1.0, 2.0], [1.0, 3.0]], (600, 1)))
    assert places.are_far(np.tile([[1.0, 2.0]], (FEWEST_ROWS, 1))).sum() == 0
