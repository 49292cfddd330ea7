from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from mapie.metrics.regression import regression_mwi_score
from scipy import stats

from softkin.core.metrics.interval import (
    clopper_pearson,
    coverage_band,
    coverage_p_value,
    covered,
    fewest_commands,
    geometric_size,
    holm,
    typical_winkler,
    widths,
    winkler_scores,
    worst_slab,
)
from softkin.uncertainty.conformal import conformal_rank


def test_winkler_by_hand() -> None:
    intervals = np.array([[[1.0, 3.0]]] * 3)
    true = np.array([[2.0], [0.5], [3.25]])
    np.testing.assert_allclose(winkler_scores(true, intervals, 0.9), [[2.0], [2.0 + 20 * 0.5], [2.0 + 20 * 0.25]])
    assert covered(true, intervals).ravel().tolist() == [True, False, False]


@pytest.mark.parametrize("level", [0.8, 0.9, 0.95])
def test_mean_winkler_score_is_mapies(level: float) -> None:
    rng = np.random.default_rng(0)
    true, centre = rng.standard_normal((2, 60, 1))
    intervals = np.stack([centre - 0.7, centre + 0.9], axis=-1)
    expected = regression_mwi_score(true[:, 0], intervals[:, 0, :, None], level)
    assert winkler_scores(true, intervals, level).mean() == pytest.approx(expected)


numbers = arrays(float, 20, elements=st.floats(-100, 100))


@given(numbers, numbers, st.floats(0, 50), st.sampled_from([0.5, 0.8, 0.9, 0.99]))
def test_winkler_is_at_least_twice_the_mean_absolute_error(
    true: np.ndarray, centre: np.ndarray, half: float, level: float
) -> None:
    intervals = np.stack([centre - half, centre + half], axis=-1)[:, None]
    scores = winkler_scores(true[:, None], intervals, level)
    assert scores.mean() >= 2 * np.abs(true - centre).mean() - 1e-9


@pytest.mark.parametrize(("n", "low", "high"), [(395, 0.858, 0.939), (140, 0.821, 0.964), (88, 0.820, 0.978)])
def test_bands_of_the_published_subsets(n: int, low: float, high: float) -> None:
    rank = conformal_rank(n, 0.9)
    assert rank is not None
    n_test = {395: 395, 140: 140, 88: 89}[n]
    assert coverage_band(n_test, n, rank) == pytest.approx((low, high), abs=6e-4)


def test_the_band_holds_what_it_says() -> None:
    """20,000 pairs of calibration and test sets: coverage lies in the band 95 % of the time or a little more."""
    rng = np.random.default_rng(1)
    n, m = 88, 89
    rank = conformal_rank(n, 0.9)
    assert rank is not None
    bound = np.sort(rng.random((20_000, n)), axis=1)[:, rank - 1]
    coverage = rng.binomial(m, bound) / m  # scores are uniform: a new one lies below the bound with that probability
    low, high = coverage_band(m, n, rank)
    share = ((coverage >= low) & (coverage <= high)).mean()
    law = stats.betabinom(m, rank, n + 1 - rank)
    exact = law.cdf(round(high * m)) - law.cdf(round(low * m) - 1)
    assert share == pytest.approx(exact, abs=4 * np.sqrt(exact * (1 - exact) / 20_000))
    assert exact >= 0.95


def test_p_values_are_small_where_coverage_is_wrong() -> None:
    assert coverage_p_value(356, 395, 395, 357) > 0.8
    assert coverage_p_value(250, 395, 395, 357) < 1e-6
    assert coverage_p_value(395, 395, 395, 357) < 1e-4


@pytest.mark.parametrize("n_rows", [1, 7, 395, 3160])
def test_clopper_pearson_is_scipys(n_rows: int) -> None:
    for n_covered in {0, 1, n_rows // 3, n_rows - 1, n_rows}:
        exact = stats.binomtest(n_covered, n_rows).proportion_ci(0.95, method="exact")
        assert clopper_pearson(n_covered, n_rows) == pytest.approx((exact.low, exact.high), rel=1e-9, abs=1e-15)


def test_clopper_pearson_holds_the_truth_often_enough() -> None:
    law = stats.binom(40, 0.35)
    probability = sum(law.pmf(k) for k in range(41) if clopper_pearson(k, 40)[0] <= 0.35 <= clopper_pearson(k, 40)[1])
    assert probability >= 0.95


def test_holm_by_hand() -> None:
    np.testing.assert_allclose(holm(np.array([0.01, 0.04, 0.03])), [0.03, 0.06, 0.06])
    assert holm(np.array([0.9, 0.8])).max() == 1.0


def test_the_size_of_a_box_is_the_side_of_a_cube_as_large() -> None:
    sizes = geometric_size(np.array([[1.0, 8.0, 1.0], [2.0, 2.0, 2.0]]))
    assert sizes == pytest.approx([2.0, 2.0])


def test_widths_are_upper_minus_lower() -> None:
    assert widths(np.array([[[1.0, 3.5], [-1.0, -1.0]]])).tolist() == [[2.5, 0.0]]


def test_the_worst_slab_is_where_rows_are_missed() -> None:
    rng = np.random.default_rng(0)
    commands = rng.uniform(-1, 1, (4000, 2)) * [1.0, 100.0]
    missed = commands[:, 1] > 60.0
    rows = worst_slab(commands, np.where(missed, 0.0, 1.0), seed=1)
    assert missed[rows].mean() > 0.8
    assert len(rows) > 0.15 * 2000
    np.testing.assert_array_equal(rows, worst_slab(commands, np.where(missed, 0.0, 1.0), seed=1))


def test_the_worst_slab_is_not_biased_where_coverage_is_everywhere_the_same() -> None:
    shares = []
    for seed in range(30):
        rng = np.random.default_rng(seed)
        commands, is_covered = rng.standard_normal((400, 3)), rng.random(400) < 0.9
        shares.append(is_covered[worst_slab(commands, is_covered.astype(float), seed, n_directions=50)].mean())
    assert np.mean(shares) == pytest.approx(0.9, abs=0.03)


def test_the_typical_winkler_score_is_a_geometric_mean() -> None:
    assert typical_winkler(np.array([0.5, 2.0, 8.0])) == pytest.approx(2.0)
    assert np.isinf(typical_winkler(np.array([1.0, np.inf])))
    assert typical_winkler(np.zeros(3)) == pytest.approx(1e-12)


def test_no_fewer_commands_can_tell_a_coverage() -> None:
    """All of n covered excludes a coverage below the level at 5 % from n on."""
    for level in (0.8, 0.9, 0.95):
        n = fewest_commands(level)
        lowest = [clopper_pearson(count, count, 0.9)[0] for count in (n - 1, n)]
        assert lowest[0] < level <= lowest[1]
