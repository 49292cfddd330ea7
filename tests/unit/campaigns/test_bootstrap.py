from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from softkin.campaigns.bootstrap import p_of_growth, p_of_growth_between

SEEDS = 300


def rejected(p_values: list[float], level: float = 0.05) -> int:
    return int((np.array(p_values) <= level).sum())


@pytest.mark.parametrize("draw", ["normal", "exponential"])
def test_where_nothing_has_grown_an_alarm_has_its_level(draw: str) -> None:
    """The number of alarms is binomial; the bound is its upper 0.1 % point, of twice the level for skewed values."""
    paired, between = [], []
    for seed in range(SEEDS):
        rng = np.random.default_rng(seed)
        one, other = getattr(rng, draw)(size=(2, 60))
        paired.append(p_of_growth(other - one, resamples=499, seed=seed))
        between.append(p_of_growth_between(one, other, resamples=499, seed=seed))
    bound = stats.binom(SEEDS, 0.05 if draw == "normal" else 0.1).ppf(0.999)
    assert rejected(paired) <= bound
    assert rejected(between) <= bound


def test_a_growth_is_found_and_a_shrinkage_is_none() -> None:
    values = np.random.default_rng(0).exponential(size=100)
    grown = values * 1.1
    assert p_of_growth(grown - values, resamples=999, seed=0) == 1 / 1000
    assert p_of_growth(values - grown, resamples=999, seed=0) == 1.0
    assert p_of_growth_between(values, values + 3, resamples=999, seed=0) == 1 / 1000


def test_equal_values_are_no_growth_and_one_growth_of_all_is_the_surest() -> None:
    assert p_of_growth(np.zeros(20), resamples=99, seed=0) == 1.0
    assert p_of_growth(np.full(20, 0.5), resamples=99, seed=0) == 1 / 100
