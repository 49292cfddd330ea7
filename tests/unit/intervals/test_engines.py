"""MAPIE, crepes and a few lines of numpy give the same intervals.

Where they differ when called plainly, and why the adapters do not: crepes 0.9.1 takes a rank one too wide at 0.9 for
n = 9 mod 10 (floating point); MAPIE's CQR corrects the two sides apart by default; both default to other levels.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from crepes import ConformalRegressor

from softkin.interface import Array, Evidence
from softkin.intervals import INTERVAL_METHODS
from softkin.intervals.conformalized_quantile_regression import intervals as cqr

LEVELS = (0.8, 0.9, 0.95)
BASE = 1  # CQR corrects the pair of the level nearest to 0.9


def evidence(n: int, n_coordinates: int = 6, n_new: int = 40, seed: int = 0) -> Evidence:
    rng = np.random.default_rng(seed)
    truth = rng.standard_normal((n, n_coordinates)) * 10
    scale = np.arange(1, n_coordinates + 1)
    predicted = truth + rng.standard_t(3, truth.shape) * scale
    return Evidence(predicted, truth, rng.standard_normal((n_new, n_coordinates)) * 10)


def quantile_evidence(n: int, n_coordinates: int = 6, n_new: int = 40, seed: int = 0) -> Evidence:
    base = evidence(n, n_coordinates, n_new, seed)
    half = np.array([1.0, 1.5, 2.0])[:, None, None]
    spread = [np.stack([centre - half, centre + half], axis=-1) for centre in (base.calibration, base.new)]
    return Evidence(spread[0], base.truth, spread[1])


def rank(n: int, level: float) -> int:
    return math.ceil(Fraction(str(level)) * (n + 1))


def split_conformal_by_hand(given: Evidence) -> Array:
    scores = np.sort(np.abs(given.truth - given.calibration), axis=0)
    levels = []
    for level in LEVELS:
        half = scores[rank(len(scores), level) - 1]
        levels.append(np.stack([given.new - half, given.new + half], axis=-1))
    return np.stack(levels)


def cqr_by_hand(given: Evidence, symmetric: bool) -> Array:
    n, levels = len(given.truth), []
    for level in LEVELS:
        below = given.calibration[BASE, ..., 0] - given.truth
        above = given.truth - given.calibration[BASE, ..., 1]
        if symmetric:
            low = high = np.sort(np.maximum(below, above), axis=0)[rank(n, level) - 1]
        else:
            k = rank(n, round(1 - (1 - level) / 2, 12))
            low, high = np.sort(below, axis=0)[k - 1], np.sort(above, axis=0)[k - 1]
        levels.append(np.stack([given.new[BASE, ..., 0] - low, given.new[BASE, ..., 1] + high], axis=-1))
    return np.stack(levels)


@pytest.mark.parametrize("n", [88, 89, 99, 140, 395])
@pytest.mark.parametrize("method", ["scp_mapie", "scp_crepes"])
def test_split_conformal_prediction_is_the_same_by_every_engine(method: str, n: int) -> None:
    given = evidence(n)
    found = INTERVAL_METHODS[method].intervals(given, LEVELS)
    np.testing.assert_allclose(found, split_conformal_by_hand(given), rtol=0, atol=1e-12)


@pytest.mark.parametrize("n", [88, 140, 395])
@pytest.mark.parametrize("symmetric", [True, False])
def test_conformalized_quantile_regression_is_romanos(n: int, symmetric: bool) -> None:
    given = quantile_evidence(n)
    found = cqr(given, LEVELS, symmetric=symmetric)
    np.testing.assert_allclose(found, cqr_by_hand(given, symmetric), rtol=0, atol=1e-12)


def test_crepes_alone_would_take_another_rank() -> None:
    """The defect the adapter is there for; when crepes mends it, this test says so."""
    scores = np.arange(1.0, 10.0)
    with pytest.warns(UserWarning, match="too small"):
        plain = ConformalRegressor().fit(scores).predict_int(np.zeros(1), confidence=0.9)[0, 1]
    given = Evidence(np.zeros((9, 1)), scores[:, None], np.zeros((1, 1)))
    ours = INTERVAL_METHODS["scp_crepes"].intervals(given, [0.9])[0, 0, 0, 1]
    assert ours == scores[rank(9, 0.9) - 1] == 9.0
    assert plain == np.inf


@pytest.mark.parametrize("method", INTERVAL_METHODS)
def test_the_shape_is_the_house_shape_and_calibrated_levels_are_nested(method: str) -> None:
    make = {"predictions": evidence, "quantiles": quantile_evidence}[INTERVAL_METHODS[method].on]
    found = INTERVAL_METHODS[method].intervals(make(88), LEVELS)
    assert found.shape == (3, 40, 6, 2)
    assert (found[..., 0] <= found[..., 1]).all()
    if INTERVAL_METHODS[method].guaranteed:
        assert (np.diff(found[..., 0], axis=0) <= 0).all()
        assert (np.diff(found[..., 1], axis=0) >= 0).all()


def test_crossed_quantiles_are_put_in_order_before_they_are_corrected() -> None:
    given = quantile_evidence(140)
    crossed = Evidence(given.calibration[..., ::-1], given.truth, given.new[..., ::-1])
    for method in ("qr", "cqr"):
        intervals = INTERVAL_METHODS[method].intervals
        np.testing.assert_array_equal(intervals(crossed, LEVELS), intervals(given, LEVELS))


def test_quantiles_far_too_wide_are_moved_together_at_most_to_a_point() -> None:
    given = quantile_evidence(88)
    wide = Evidence(given.truth[None, ..., None] + [-50.0, 50.0] + np.zeros((3, 1, 1, 1)), given.truth, given.new)
    found = INTERVAL_METHODS["cqr"].intervals(wide, LEVELS)
    np.testing.assert_array_equal(found[..., 0], found[..., 1])


@pytest.mark.parametrize("method", [name for name, method in INTERVAL_METHODS.items() if method.guaranteed])
def test_too_few_calibration_rows_give_infinite_intervals(method: str) -> None:
    make = {"predictions": evidence, "quantiles": quantile_evidence}[INTERVAL_METHODS[method].on]
    found = INTERVAL_METHODS[method].intervals(make(12), LEVELS)
    assert np.isfinite(found[:2]).all()
    assert np.isinf(found[2]).all()


@pytest.mark.parametrize("method", INTERVAL_METHODS)
def test_global_random_state_is_left_alone(method: str) -> None:
    make = {"predictions": evidence, "quantiles": quantile_evidence}[INTERVAL_METHODS[method].on]
    np.random.seed(3)
    before = np.random.get_state()[1].copy()
    INTERVAL_METHODS[method].intervals(make(88), LEVELS)
    np.testing.assert_array_equal(np.random.get_state()[1], before)


@pytest.mark.parametrize("method", ["scp_mapie", "scp_crepes"])
def test_two_dimensions_where_one_is_meant_are_refused(method: str) -> None:
    with pytest.raises(ValueError, match="shape"):
        INTERVAL_METHODS[method].intervals(Evidence(np.zeros(9), np.zeros((9, 1)), np.zeros((2, 1))), LEVELS)
