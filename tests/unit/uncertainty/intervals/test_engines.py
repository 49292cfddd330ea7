"""MAPIE, crepes and a few lines of numpy give the same intervals.

Where they differ when called plainly, and why the adapters do not: crepes 0.9.1 takes a rank one too wide at 0.9 for
n = 9 mod 10 (floating point); MAPIE's CQR corrects the two sides apart by default; both default to other levels.
"""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from crepes import ConformalPredictiveSystem, ConformalRegressor

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import Evidence, RefitEvidence, Shell, ShellEvidence
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.intervals.conformalized_quantile_regression import intervals as cqr
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod
from softkin.uncertainty.intervals.split_conformal_distance import LEAST_DIFFICULTY, distances

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


def spread_evidence(n: int, n_coordinates: int = 6, n_new: int = 40, seed: int = 0) -> Evidence:
    base, rng = evidence(n, n_coordinates, n_new, seed), np.random.default_rng(seed + 1)
    spreads = [rng.uniform(0.5, 2.0, (rows, n_coordinates)) for rows in (50, n, n_new)]
    commands = [rng.standard_normal((rows, 2)) for rows in (50, n, n_new)]
    return Evidence(base.calibration, base.truth, base.new, *spreads, *commands)


def refit_evidence(n: int, n_coordinates: int = 6, n_new: int = 40, seed: int = 0, *, folds: bool) -> RefitEvidence:
    rng = np.random.default_rng(seed)
    truth = rng.standard_normal((n, n_coordinates)) * 10
    if folds:
        fold_of_row = rng.permutation(np.arange(n) % 5)
        inside = [np.flatnonzero(fold_of_row != fold) for fold in range(5)]
    else:
        inside = list(rng.integers(n, size=(30, n)))
    train = truth + rng.standard_t(3, (len(inside), n, n_coordinates))
    return RefitEvidence(inside, train, truth, rng.standard_normal((len(inside), n_new, n_coordinates)) * 10)


def shell_evidence(n: int, n_coordinates: int = 6, n_new: int = 40, seed: int = 0) -> ShellEvidence:
    """Cores of commands within 0.5, 0.7 and 0.85 of the reach; errors grow with the norm. Half of `new` is outside."""
    rng = np.random.default_rng(seed)
    train = rng.uniform(-1, 1, (300, 2))
    norms = np.linalg.norm(train, axis=1)
    inside = rng.uniform(-0.5, 0.5, (n_new - n_new // 2, 2))
    outside = inside[: n_new // 2] * 1.5 / np.linalg.norm(inside[: n_new // 2], axis=1)[:, None]
    base = evidence(n, n_coordinates, n_new, seed)
    commands = (train, rng.uniform(-1, 1, (n, 2)), np.concatenate([inside, outside]))
    deployed = Evidence(base.calibration, base.truth, base.new, None, None, None, *commands)
    shells = []
    for reach in (0.5, 0.7, 0.85):
        shell = train[norms > reach]
        truth = rng.standard_normal((len(shell), n_coordinates))
        errors = rng.standard_normal(truth.shape) * np.linalg.norm(shell, axis=1)[:, None] ** 2
        shells.append(Shell(train[norms <= reach], shell, truth + errors, truth))
    return ShellEvidence(deployed, shells, lambda rows: np.asarray(np.linalg.norm(rows, axis=1)))


def evidence_for(method: IntervalMethod, n: int) -> Evidence | RefitEvidence | ShellEvidence:
    if method.on == "shells":
        return shell_evidence(n)
    if method.on in ("folds", "resamples"):
        return refit_evidence(n, folds=method.on == "folds")
    return quantile_evidence(n) if method.on == "quantiles" else spread_evidence(n)


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


@pytest.mark.parametrize("n", [88, 140, 395])
def test_a_difficulty_scales_the_half_width(n: int) -> None:
    given = spread_evidence(n)
    assert given.train_spread is not None
    assert given.calibration_spread is not None
    assert given.new_spread is not None
    least = 0.1 * given.train_spread.mean(axis=0)
    scores = np.sort(np.abs(given.truth - given.calibration) / (given.calibration_spread + least), axis=0)
    found = INTERVAL_METHODS["scp_spread"].intervals(given, LEVELS)
    for place, level in enumerate(LEVELS):
        half = scores[rank(n, level) - 1] * (given.new_spread + least)
        expected = np.stack([given.new - half, given.new + half], axis=-1)
        np.testing.assert_allclose(found[place], expected, rtol=0, atol=1e-10)


def test_the_difficulty_grows_with_the_distance_without_end() -> None:
    """crepes' own estimate stops at the edge of the training box."""
    train = np.random.default_rng(0).uniform(-1, 1, (200, 2))
    (found,) = distances(train, [np.array([[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [8.0, 0.0]])])
    assert (np.diff(found) > 4).all()
    copies = np.repeat(train[:10], 20, axis=0)
    (same,) = distances(copies, [copies[:1]])
    assert same.tolist() == [LEAST_DIFFICULTY]


@pytest.mark.parametrize("n", [88, 140, 395])
def test_a_predictive_system_gives_the_residuals_quantiles(n: int) -> None:
    given = evidence(n)
    found = INTERVAL_METHODS["cps"].intervals(given, LEVELS)
    residuals = np.sort(given.truth - given.calibration, axis=0)
    for place, level in enumerate(LEVELS):
        upper = rank(n, round((1 + level) / 2, 12))
        expected = np.stack([given.new + residuals[n - upper], given.new + residuals[upper - 1]], axis=-1)
        np.testing.assert_allclose(found[place], expected, rtol=0, atol=1e-12)


def test_the_crps_of_a_predictive_system_is_crepes_and_its_definition() -> None:
    given, true = evidence(88), np.random.default_rng(9).standard_normal((40, 6)) * 10
    crps = INTERVAL_METHODS["cps"].crps
    assert crps is not None
    found = crps(given, true)
    for coordinate in range(6):
        residuals = (given.truth - given.calibration)[:, coordinate]
        system = ConformalPredictiveSystem().fit(residuals)
        theirs = system.evaluate(given.new[:, coordinate], true[:, coordinate], metrics=["CRPS"])["CRPS"]
        assert found[:, coordinate].mean() == pytest.approx(theirs, rel=1e-9)
        draws = given.new[0, coordinate] + residuals
        spread = np.abs(draws[:, None] - draws).mean() / 2
        assert found[0, coordinate] == pytest.approx(np.abs(draws - true[0, coordinate]).mean() - spread)


def test_the_crps_of_a_normal_distribution_is_that_of_its_draws() -> None:
    given, true = spread_evidence(88), np.random.default_rng(9).standard_normal((40, 6)) * 3
    crps = INTERVAL_METHODS["gaussian"].crps
    assert crps is not None
    assert given.new_spread is not None
    found = crps(given, true)[0, 0]
    draws = given.new[0, 0] + given.new_spread[0, 0] * np.random.default_rng(0).standard_normal((2, 400_000))
    sampled = np.abs(draws[0] - true[0, 0]).mean() - np.abs(draws[0] - draws[1]).mean() / 2
    assert found == pytest.approx(sampled, rel=5e-3)
    exact = replace(given, new_spread=np.zeros_like(given.new_spread))
    np.testing.assert_array_equal(crps(exact, true), np.abs(true - given.new))


@pytest.mark.parametrize("n", [88, 140, 395])
def test_cv_plus_is_barbers(n: int) -> None:
    given = refit_evidence(n, folds=True)
    found = INTERVAL_METHODS["cv_plus"].intervals(given, LEVELS)
    outside = [np.setdiff1d(np.arange(n), inside) for inside in given.inside]
    fold = np.empty(n, dtype=int)
    for place, rows in enumerate(outside):
        fold[rows] = place
    held_out = given.train[fold, np.arange(n)]
    residuals = np.abs(given.truth - held_out)
    low = np.sort(given.new[fold] - residuals[:, None], axis=0)
    high = np.sort(given.new[fold] + residuals[:, None], axis=0)
    for place, level in enumerate(LEVELS):
        k = rank(n, level)
        expected = np.stack([low[n - k], high[k - 1]], axis=-1)
        np.testing.assert_allclose(found[place], expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("n", [88, 140])
def test_jackknife_plus_after_bootstrap_is_kims(n: int) -> None:
    given = refit_evidence(n, folds=False)
    found = INTERVAL_METHODS["jackknife_plus_ab"].intervals(given, LEVELS)
    left_out = np.stack([~np.isin(np.arange(n), inside) for inside in given.inside])
    weights = left_out / left_out.sum(axis=0)
    held_out = np.einsum("kn,kni->ni", weights, given.train)
    residuals = np.abs(given.truth - held_out)
    centres = np.einsum("kn,kmi->nmi", weights, given.new)
    low, high = np.sort(centres - residuals[:, None], axis=0), np.sort(centres + residuals[:, None], axis=0)
    for place, level in enumerate(LEVELS):
        k = rank(n, level)
        expected = np.stack([low[n - k], high[k - 1]], axis=-1)
        np.testing.assert_allclose(found[place], expected, rtol=0, atol=1e-10)


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
def test_the_shape_is_the_house_shape_and_levels_are_nested(method: str) -> None:
    """But for QR, whose quantiles are learnt each by itself."""
    found = INTERVAL_METHODS[method].intervals(evidence_for(INTERVAL_METHODS[method], 88), LEVELS)
    assert found.shape == (3, 40, 6, 2)
    assert (found[..., 0] <= found[..., 1]).all()
    if INTERVAL_METHODS[method].on != "quantiles" or INTERVAL_METHODS[method].guarantee == MARGINAL:
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


@pytest.mark.parametrize("method", [name for name, method in INTERVAL_METHODS.items() if method.guarantee == MARGINAL])
def test_too_few_calibration_rows_give_infinite_intervals(method: str) -> None:
    spec, n = INTERVAL_METHODS[method], 12
    assert spec.rank is not None
    found = spec.intervals(evidence_for(spec, n), LEVELS)
    suffices = [spec.rank(n, level) is not None for level in LEVELS]
    assert suffices in ([True, True, False], [True, False, False])
    for level, enough in zip(found, suffices, strict=True):
        assert (np.isfinite(level) if enough else np.isinf(level)).all()


@pytest.mark.parametrize("method", INTERVAL_METHODS)
def test_global_random_state_is_left_alone(method: str) -> None:
    np.random.seed(3)
    before = np.random.get_state()[1].copy()
    INTERVAL_METHODS[method].intervals(evidence_for(INTERVAL_METHODS[method], 88), LEVELS)
    np.testing.assert_array_equal(np.random.get_state()[1], before)


@pytest.mark.parametrize("method", ["scp_mapie", "scp_crepes"])
def test_two_dimensions_where_one_is_meant_are_refused(method: str) -> None:
    with pytest.raises(ValueError, match="shape"):
        INTERVAL_METHODS[method].intervals(Evidence(np.zeros(9), np.zeros((9, 1)), np.zeros((2, 1))), LEVELS)
