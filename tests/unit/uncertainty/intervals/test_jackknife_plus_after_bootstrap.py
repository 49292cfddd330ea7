from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.intervals.jackknife_plus_after_bootstrap import intervals
from tests.unit.uncertainty.conftest import LEVELS, rank, resample_calibration


@pytest.mark.parametrize("n", [88, 140])
def test_intervals_are_kims(n: int) -> None:
    data = resample_calibration(n)
    bounds = intervals(data, LEVELS)
    left_out = np.stack([~np.isin(np.arange(n), fitted_rows) for fitted_rows in data.fitted_rows])
    weights = left_out / left_out.sum(axis=0)
    held_out = np.einsum("kn,kni->ni", weights, data.train)
    residuals = np.abs(data.truth - held_out)
    centres = np.einsum("kn,kmi->nmi", weights, data.new)
    low, high = np.sort(centres - residuals[:, None], axis=0), np.sort(centres + residuals[:, None], axis=0)
    for place, level in enumerate(LEVELS):
        k = rank(n, level)
        expected = np.stack([low[n - k], high[k - 1]], axis=-1)
        np.testing.assert_allclose(bounds[place], expected, rtol=0, atol=1e-10)
