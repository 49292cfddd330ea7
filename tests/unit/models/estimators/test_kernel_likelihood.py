from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.gaussian_process import GaussianProcessRegressor

from softkin.models.estimators.bounded_gaussian_process import BoundedGaussianProcess
from softkin.models.estimators.kernel_likelihood import SHAPES, TREND_TERMS, Likelihood

JITTER = 1e-10
KERNELS = [("none", "paper_linear"), *((kernel, trend) for kernel in SHAPES for trend in TREND_TERMS)]


@pytest.mark.parametrize(("kernel", "trend"), KERNELS)
@settings(max_examples=30)
@given(
    seed=st.integers(0, 1000),
    shape=st.tuples(st.integers(3, 40), st.integers(1, 4), st.integers(1, 5)),
    step=st.floats(0, 0.5),
)
def test_value_and_gradient_are_scikit_learns(
    kernel: str, trend: str, seed: int, shape: tuple[int, int, int], step: float
) -> None:
    rng, (n_rows, n_commands, n_coordinates) = np.random.default_rng(seed), shape
    X, y = rng.standard_normal((n_rows, n_commands)), rng.standard_normal((n_rows, n_coordinates))
    model = BoundedGaussianProcess(kernel, trend)
    theirs = GaussianProcessRegressor(model._kernel(n_commands), alpha=JITTER, optimizer=None).fit(X, y)
    theta = theirs.kernel_.theta + step * rng.standard_normal(len(theirs.kernel_.theta))
    value, gradient = theirs.log_marginal_likelihood(theta, eval_gradient=True)
    ours, our_gradient = Likelihood(model._terms(X), y, JITTER)(theta)
    assert ours == pytest.approx(-value, rel=1e-10)
    np.testing.assert_allclose(our_gradient, -gradient, rtol=1e-8, atol=1e-10 * np.abs(gradient).max())


@pytest.mark.parametrize(("kernel", "trend"), KERNELS)
def test_the_gradient_is_the_slope_of_the_value(kernel: str, trend: str) -> None:
    rng = np.random.default_rng(0)
    model = BoundedGaussianProcess(kernel, trend)
    X, y = rng.standard_normal((20, 3)), rng.standard_normal((20, 4))
    objective, theta = Likelihood(model._terms(X), y, JITTER), model._kernel(3).theta
    for place, gradient in enumerate(objective(theta)[1]):
        step = np.zeros_like(theta)
        step[place] = 1e-5
        slope = (objective(theta + step)[0] - objective(theta - step)[0]) / 2e-5
        assert slope == pytest.approx(gradient, rel=1e-5, abs=1e-5)


def test_a_matrix_that_cannot_be_factorised_is_infinitely_unlikely() -> None:
    X, y = np.zeros((5, 2)), np.ones((5, 1))
    terms = BoundedGaussianProcess("rbf")._terms(X)
    value, gradient = Likelihood(terms, y, 0.0)(np.array([0.0, 0.0, 0.0, -1000.0]))
    assert value == np.inf
    assert not gradient.any()
