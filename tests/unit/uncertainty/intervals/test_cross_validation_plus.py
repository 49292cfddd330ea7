from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from softkin.uncertainty.intervals.cross_validation_plus import intervals
from tests.unit.uncertainty.conftest import LEVELS, fold_calibration, rank


@pytest.mark.parametrize("n", [88, 140, 395])
def test_intervals_are_barbers(n: int) -> None:
    data = fold_calibration(n)
    bounds = intervals(data, LEVELS)
    fold = np.empty(n, dtype=int)
    for place, fitted_rows in enumerate(data.fitted_rows):
        fold[np.setdiff1d(np.arange(n), fitted_rows)] = place
    held_out = data.train[fold, np.arange(n)]
    residuals = np.abs(data.truth - held_out)
    low = np.sort(data.new[fold] - residuals[:, None], axis=0)
    high = np.sort(data.new[fold] + residuals[:, None], axis=0)
    for place, level in enumerate(LEVELS):
        k = rank(n, level)
        expected = np.stack([low[n - k], high[k - 1]], axis=-1)
        np.testing.assert_allclose(bounds[place], expected, rtol=0, atol=1e-12)


def test_predictions_of_rows_that_a_fit_has_seen_do_not_matter() -> None:
    data = fold_calibration(88)
    garbage = data.train.copy()
    for of_fit, fitted_rows in zip(garbage, data.fitted_rows, strict=True):
        of_fit[fitted_rows] = 1e6
    np.testing.assert_allclose(intervals(replace(data, train=garbage), LEVELS), intervals(data, LEVELS), atol=1e-9)
