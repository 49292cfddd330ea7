"""Bounds of CV+ and jackknife+-after-bootstrap are MAPIE's, to the bit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from softkin.core.folds import grouped_folds
from softkin.training.refit import RefittingSettings, drawn_resamples
from softkin.uncertainty import refit_bounds
from softkin.uncertainty.calibration_data import FoldCalibration, RefitCalibration, ResampleCalibration
from softkin.uncertainty.refit_bounds import plus_intervals
from tests.unit.uncertainty.conftest import LEVELS, fold_calibration, resample_calibration
from tests.unit.uncertainty.mapie_refits import intervals_by_mapie

#: Ties, numbers of any size, and those in between.
POSITIONS = st.one_of(st.integers(-3, 3).map(float), st.floats(-1e3, 1e3))


@st.composite
def calibrations(draw: st.DrawFn) -> RefitCalibration:
    """Folds grouped by command, of which some are repeated; or bootstrap samples."""
    n, n_new, seed = draw(st.integers(6, 60)), draw(st.integers(1, 20)), draw(st.integers(0, 9))
    kind: type[RefitCalibration]
    if draw(st.booleans()):
        commands = np.random.default_rng(seed).integers(draw(st.integers(6, 60)), size=(n, 1)).astype(float)
        commands[:2] = [[-1.0], [-2.0]]
        n_folds = min(draw(st.integers(2, 5)), len(np.unique(commands)))
        kind, fitted_rows = FoldCalibration, [rows for rows, _ in grouped_folds(commands, n_folds, seed)]
    else:
        kind, fitted_rows = ResampleCalibration, drawn_resamples(n, RefittingSettings(5, 20, 100, seed))
    shapes = (len(fitted_rows), n, 2), (n, 2), (len(fitted_rows), n_new, 2)
    return kind(fitted_rows, *(draw(arrays(np.float64, shape, elements=POSITIONS)) for shape in shapes))


@settings(max_examples=20)  # one wrong rank shows in nearly every one
@given(data=calibrations())
def test_bounds_are_mapies_to_the_bit(data: RefitCalibration) -> None:
    np.testing.assert_array_equal(plus_intervals(data, LEVELS), intervals_by_mapie(data, LEVELS))


@pytest.mark.parametrize("data", [fold_calibration(395), resample_calibration(395)], ids=["folds", "resamples"])
def test_bounds_of_more_rows_than_are_held_at_a_time(data: RefitCalibration, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(refit_bounds, "N_ROWS", 7)
    np.testing.assert_array_equal(plus_intervals(data, LEVELS), intervals_by_mapie(data, LEVELS))


@pytest.mark.parametrize("data", [fold_calibration(88), resample_calibration(88)], ids=["folds", "resamples"])
def test_a_level_that_train_is_too_small_for_has_no_bounds(data: RefitCalibration) -> None:
    bounds = plus_intervals(data, [0.5, 0.99])
    np.testing.assert_array_equal(bounds[:1], plus_intervals(data, [0.5]))
    assert np.isfinite(bounds[0]).all()
    assert (bounds[1] == [-np.inf, np.inf]).all()
    assert (plus_intervals(data, [0.99]) == bounds[1:]).all()


def test_the_score_of_a_row_of_train_comes_from_the_refits_that_hold_it_out_alone() -> None:
    data = resample_calibration(88)
    garbage = data.train.copy()
    for of_fit, fitted_rows in zip(garbage, data.fitted_rows, strict=True):
        of_fit[fitted_rows] = 1e6
    np.testing.assert_array_equal(plus_intervals(replace(data, train=garbage), LEVELS), plus_intervals(data, LEVELS))
