from __future__ import annotations

import numpy as np
import pytest
from sklearn.metrics import mean_pinball_loss

from softkin.core.metrics.pinball import pinball_losses


@pytest.mark.parametrize("quantile", [0.05, 0.5, 0.9])
def test_it_is_scikit_learns_and_least_at_the_quantile(quantile: float) -> None:
    rng = np.random.default_rng(0)
    true, predicted = rng.standard_normal((2, 500))
    expected = mean_pinball_loss(true, predicted, alpha=quantile)
    assert pinball_losses(true, predicted, quantile).mean() == pytest.approx(expected)
    grid = np.linspace(-3, 3, 601)
    best = grid[np.argmin([pinball_losses(true, value, quantile).mean() for value in grid])]
    assert best == pytest.approx(np.quantile(true, quantile), abs=0.02)
