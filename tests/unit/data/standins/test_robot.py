"""How commands are drawn."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binom

from softkin.core.samples import Array
from softkin.data.standins.robot import evenly, in_box, in_disc


def draw(seed: int = 0, n_rows: int = 2000) -> Array:
    return evenly(n_rows, 2, np.random.default_rng(seed))


def test_commands_fill_the_range_more_evenly_than_chance() -> None:
    for column in draw().T:
        counts = np.histogram(column, bins=20, range=(0, 1))[0]
        assert np.abs(counts - 100).max() <= 3  # chance would miss by about 20


def test_commands_are_distinct_and_follow_the_seed() -> None:
    assert len(np.unique(draw(), axis=0)) == 2000
    assert np.array_equal(draw(), draw())
    assert not np.isin(draw(), draw(seed=1)).any()


@pytest.mark.parametrize("column", [0, 1])
def test_a_command_is_approached_from_either_side(column: int) -> None:
    """In Halton's own order all moves into one half come from the other; in random order half of them do."""
    low = draw()[:, column] < 0.5
    stayed = int((low[1:] == low[:-1]).sum())
    lowest, highest = binom.interval(1 - 1e-6, len(low) - 1, 0.5)
    assert lowest <= stayed <= highest


def test_box_and_disc() -> None:
    boxed = in_box(500, (-1.0, 2.0), (0.5, 3.0), np.random.default_rng(0))
    assert (boxed.min(axis=0) >= (-1.0, 2.0)).all()
    assert (boxed.max(axis=0) <= (0.5, 3.0)).all()
    norms = np.linalg.norm(in_disc(500, 20.0, np.random.default_rng(0)), axis=1)
    np.testing.assert_allclose(np.sort(norms), np.linspace(0, 20, 500), atol=0.2)
