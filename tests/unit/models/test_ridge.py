from __future__ import annotations

import numpy as np
from sklearn.linear_model import LinearRegression
from sklearn.preprocessing import PolynomialFeatures

from softkin.models.ridge import SPEC
from tests.conftest import bending_arm


def test_without_a_penalty_it_is_least_squares_on_the_powers() -> None:
    rows = bending_arm(80)
    features = PolynomialFeatures(3, include_bias=False).fit_transform(rows.commands)
    expected = LinearRegression().fit(features, rows.positions).predict(features)
    fitted = SPEC.build({"degree": 3, "alpha": 1e-10}, 0, 1).fit(rows.commands, rows.positions)
    np.testing.assert_allclose(fitted.predict(rows.commands), expected, atol=1e-6)


def test_a_large_penalty_leaves_the_mean() -> None:
    rows = bending_arm(80)
    fitted = SPEC.build({"degree": 2, "alpha": 1e12}, 0, 1).fit(rows.commands, rows.positions)
    expected = np.broadcast_to(rows.positions.mean(axis=0), rows.positions.shape)
    np.testing.assert_allclose(fitted.predict(rows.commands), expected, atol=1e-6)


def test_the_penalty_shrinks_the_weights() -> None:
    rows = bending_arm(80)
    norms = [
        np.linalg.norm(SPEC.build({"degree": 2, "alpha": alpha}, 0, 1).fit(rows.commands, rows.positions)[-1].coef_)
        for alpha in (1e-8, 1.0, 100.0)
    ]
    assert norms == sorted(norms, reverse=True)
    assert norms[0] > 1.5 * norms[2]
