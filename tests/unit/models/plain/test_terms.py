from __future__ import annotations

import numpy as np
import pytest
from sklearn.preprocessing import PolynomialFeatures

from softkin.models.plain.describe import _factors
from softkin.models.plain.terms import terms_of_many

X = np.random.default_rng(0).uniform(-2, 2, (40, 3))


@pytest.mark.parametrize("include_bias", [False, True])
def test_terms_are_those_of_scikit_learn(include_bias: bool) -> None:
    features = PolynomialFeatures(4, include_bias=include_bias).fit(X)
    terms = terms_of_many(_factors(features.powers_), 3)(X)
    np.testing.assert_allclose(terms.T, features.transform(X), rtol=1e-14)


def test_terms_whose_beginnings_are_no_terms() -> None:
    terms = terms_of_many(np.array([[0, 0, 2], [2, 1, 3], [3, 3, 3]]), 3)(X)
    np.testing.assert_allclose(terms, [X[:, 0] ** 2 * X[:, 2], X[:, 2] * X[:, 1], np.ones(40)], rtol=1e-14)
