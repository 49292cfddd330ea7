from __future__ import annotations

import numpy as np
import pytest
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, ExpSineSquared, WhiteKernel
from sklearn.svm import SVR

from softkin.core.errors import ConfigError
from softkin.models.plain.describe_kernels import of_support_vectors, terms_of
from softkin.models.plain.evaluate import regressor

X = np.random.default_rng(0).normal(size=(40, 2))


def test_terms_of_a_sum() -> None:
    terms, noise = terms_of(ConstantKernel(4.0) * RBF([1.0, 2.0]) + WhiteKernel(0.5), 2)
    assert noise == 0.5
    assert [term["shape"] for term in terms] == ["exponential"]
    assert terms[0]["constant"] == 4.0
    np.testing.assert_array_equal(terms[0]["lengths"], [1.0, 2.0])


def test_kernels_that_are_not_known_are_refused() -> None:
    with pytest.raises(ConfigError, match="ExpSineSquared"):
        terms_of(ConstantKernel() * ExpSineSquared(), 2)
    with pytest.raises(ConfigError, match="'sigmoid' cannot"):
        of_support_vectors([SVR(kernel="sigmoid").fit(X, X[:, 0])], None)


@pytest.mark.parametrize("kernel", ["rbf", "poly", "linear"])
def test_support_vectors_of_two_targets(kernel: str) -> None:
    machines = [SVR(kernel=kernel, epsilon=0.3).fit(X, np.sin(X[:, target])) for target in (0, 1)]
    targets = regressor(of_support_vectors(machines, None))(X)[0]
    np.testing.assert_allclose(targets, np.column_stack([one.predict(X) for one in machines]), atol=1e-12)
