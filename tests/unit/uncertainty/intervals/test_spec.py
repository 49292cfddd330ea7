"""What an interval method declares of itself holds for every entry of the registry."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.conformal import conformal_rank
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.intervals.spec import MARGINAL, REGIMES
from tests.unit.uncertainty.conftest import LEVELS, MAKERS, global_random_state, spread_calibration


def test_a_regime_is_the_name_of_a_method_or_none() -> None:
    assert REGIMES == ("auto", "in_domain")
    assert set(REGIMES) & set(INTERVAL_METHODS) == {"auto"}


@pytest.mark.parametrize("method", INTERVAL_METHODS)
def test_intervals_have_one_shape_and_levels_are_nested(method: str) -> None:
    """But for QR, whose quantiles are learnt each by itself."""
    spec = INTERVAL_METHODS[method]
    bounds = spec.intervals(MAKERS[spec.calibrated_on](88), LEVELS)
    assert bounds.shape == (3, 40, 6, 2)
    assert (bounds[..., 0] <= bounds[..., 1]).all()
    if not spec.calibrated_on.needs_quantiles or spec.guarantee == MARGINAL:
        assert (np.diff(bounds[..., 0], axis=0) <= 0).all()
        assert (np.diff(bounds[..., 1], axis=0) >= 0).all()


@pytest.mark.parametrize("method", [name for name, method in INTERVAL_METHODS.items() if method.has_constant_width])
def test_a_constant_width_is_constant(method: str) -> None:
    spec = INTERVAL_METHODS[method]
    bounds = spec.intervals(MAKERS[spec.calibrated_on](88), LEVELS)
    np.testing.assert_allclose(np.ptp(bounds[..., 1] - bounds[..., 0], axis=1), 0, atol=1e-9)


@pytest.mark.parametrize("method", [name for name, method in INTERVAL_METHODS.items() if method.guarantee == MARGINAL])
def test_too_few_calibration_rows_give_infinite_intervals(method: str) -> None:
    spec, n = INTERVAL_METHODS[method], 12
    assert spec.rank is not None
    bounds = spec.intervals(MAKERS[spec.calibrated_on](n), LEVELS)
    suffices = [spec.rank(n, level) is not None for level in LEVELS]
    assert suffices in ([True, True, False], [True, False, False])
    for level, enough in zip(bounds, suffices, strict=True):
        assert (np.isfinite(level) if enough else np.isinf(level)).all()


@pytest.mark.parametrize("method", INTERVAL_METHODS)
def test_global_random_state_is_left_alone(method: str) -> None:
    spec = INTERVAL_METHODS[method]
    np.random.seed(3)
    before = global_random_state()
    spec.intervals(MAKERS[spec.calibrated_on](88), LEVELS)
    np.testing.assert_array_equal(global_random_state(), before)


@pytest.mark.parametrize("method", ["scp_mapie", "scp_crepes", "scp_spread", "scp_distance", "cps"])
def test_coverage_over_random_splits_is_what_theory_says(method: str) -> None:
    """300 splits of 88 calibration and 89 test rows, as FINGER has: mean coverage is k / (n + 1), within 4 errors."""
    n, m, splits, levels = 88, 89, 300, [0.8, 0.9]
    spec = INTERVAL_METHODS[method]
    shares = []
    rng = np.random.default_rng(5)
    for split in range(splits):
        base = spread_calibration(n, 3, m, split)
        truth = base.new + rng.standard_t(3, base.new.shape) * np.arange(1, 4)
        bounds = spec.intervals(base, levels)
        shares.append(((bounds[..., 0] <= truth) & (truth <= bounds[..., 1])).mean(axis=1))
    means, errors = np.mean(shares, axis=0), np.std(shares, axis=0) / np.sqrt(splits)
    for place, level in enumerate(levels):
        assert spec.rank is not None
        rank = spec.rank(n, level)
        assert rank is not None
        assert level <= rank / (n + 1) <= level + 2 / (n + 1)
        np.testing.assert_array_less(np.abs(means[place] - rank / (n + 1)), 4 * errors[place])
    assert conformal_rank(n, 0.9) == 81
