from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from softkin.uncertainty.held_out_difficulty import fit_difficulty
from softkin.uncertainty.intervals.split_conformal_held_out import intervals, scaled
from tests.unit.uncertainty.conftest import LEVELS, held_out_calibration, rank, split_conformal_by_hand


@pytest.mark.parametrize("n", [88, 395])
def test_the_half_width_is_proportional_to_the_difficulty(n: int) -> None:
    data = held_out_calibration(n)
    known, new = data.difficulty.of(data.calibration_commands), data.difficulty.of(data.new_commands)
    assert np.ptp(np.log(known)) > 1
    scores = np.sort(np.abs(data.truth - data.calibration) / known, axis=0)
    sides = scaled(data).sides(LEVELS)
    for place, bounds in enumerate(intervals(data, LEVELS)):
        half = scores[rank(n, LEVELS[place]) - 1]
        np.testing.assert_allclose(bounds[..., 1] - data.new, half * new, atol=1e-10)
        np.testing.assert_allclose(sides[place], np.stack([-half, half], axis=-1))


def test_where_errors_tell_nothing_it_is_split_conformal_prediction() -> None:
    data = held_out_calibration(88)
    same = fit_difficulty(data.train_commands, np.ones((50, 6)), np.arange(6))
    np.testing.assert_allclose(intervals(replace(data, difficulty=same), LEVELS), split_conformal_by_hand(data))
