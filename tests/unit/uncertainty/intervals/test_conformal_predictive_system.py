from __future__ import annotations

import numpy as np
import pytest
from crepes import ConformalPredictiveSystem

from softkin.uncertainty.intervals.conformal_predictive_system import crps, intervals
from tests.unit.uncertainty.conftest import LEVELS, point_calibration, rank


@pytest.mark.parametrize("n", [88, 140, 395])
def test_bounds_are_quantiles_of_the_residuals(n: int) -> None:
    data = point_calibration(n)
    bounds = intervals(data, LEVELS)
    residuals = np.sort(data.truth - data.calibration, axis=0)
    for place, level in enumerate(LEVELS):
        upper = rank(n, round((1 + level) / 2, 12))
        expected = np.stack([data.new + residuals[n - upper], data.new + residuals[upper - 1]], axis=-1)
        np.testing.assert_allclose(bounds[place], expected, rtol=0, atol=1e-12)


def test_without_a_level_that_the_rows_suffice_for_all_is_infinite() -> None:
    assert np.isinf(intervals(point_calibration(5), LEVELS)).all()


def test_the_crps_is_crepes_and_its_definition() -> None:
    data, true = point_calibration(88), np.random.default_rng(9).standard_normal((40, 6)) * 10
    scores = crps(data, true)
    for coordinate in range(6):
        residuals = (data.truth - data.calibration)[:, coordinate]
        system = ConformalPredictiveSystem().fit(residuals)
        theirs = system.evaluate(data.new[:, coordinate], true[:, coordinate], metrics=["CRPS"])["CRPS"]
        assert scores[:, coordinate].mean() == pytest.approx(theirs, rel=1e-9)
        draws = data.new[0, coordinate] + residuals
        spread = np.abs(draws[:, None] - draws).mean() / 2
        assert scores[0, coordinate] == pytest.approx(np.abs(draws - true[0, coordinate]).mean() - spread)
