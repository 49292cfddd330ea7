from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import HuberRegressor
from sklearn.linear_model._huber import _huber_loss_and_gradient

from softkin.core.samples import Array
from softkin.models.estimators.quick_huber import HuberLoss, QuickHuber

pytestmark = pytest.mark.filterwarnings("ignore::sklearn.exceptions.ConvergenceWarning")


def rows(n_rows: int, n_features: int, seed: int) -> tuple[Array, Array]:
    """A plane with noise, every seventh row a gross error."""
    rng = np.random.default_rng(seed)
    X = rng.standard_normal((n_rows, n_features))
    y = X @ rng.standard_normal(n_features) + 0.1 * rng.standard_normal(n_rows)
    y[::7] += 20.0
    return X, y


@given(
    sizes=st.tuples(st.integers(1, 40), st.integers(1, 9)),
    epsilon=st.floats(1.05, 3.0),
    alpha=st.sampled_from([0.0, 1e-4, 0.3]),
    scale=st.sampled_from([1e-3, 1.0, 1e3]),
    seed=st.integers(0, 1000),
)
def test_loss_and_gradient_are_scikit_learns_to_the_bit(
    sizes: tuple[int, int], epsilon: float, alpha: float, scale: float, seed: int
) -> None:
    """A scale of a thousand has no row beyond epsilon scales, one of a thousandth hardly any within."""
    X, y = rows(*sizes, seed)
    loss = HuberLoss(X, y, epsilon=epsilon, alpha=alpha)
    rng = np.random.default_rng(seed)
    packed = np.append(rng.standard_normal(sizes[1] + 1), scale)
    for nearby in (packed, packed, packed + 1e-12, rng.permutation(packed) ** 2 + 0.1):
        expected, gradient = _huber_loss_and_gradient(nearby, X, y, epsilon, alpha, np.ones(len(X)))
        got, own = loss(nearby)
        assert got == expected
        np.testing.assert_array_equal(own, gradient)


@pytest.mark.parametrize(("n_rows", "n_features", "max_iter"), [(60, 4, 1000), (300, 65, 1000), (300, 65, 5)])
def test_a_fit_is_scikit_learns_to_the_bit(n_rows: int, n_features: int, max_iter: int) -> None:
    X, y = rows(n_rows, n_features, 1)
    settings = {"epsilon": 1.35, "alpha": 1e-5, "max_iter": max_iter}
    expected, got = (kind(**settings).fit(X, y) for kind in (HuberRegressor, QuickHuber))
    np.testing.assert_array_equal(got.coef_, expected.coef_)
    assert (got.intercept_, got.scale_, got.n_iter_) == (expected.intercept_, expected.scale_, expected.n_iter_)
    np.testing.assert_array_equal(got.outliers_, expected.outliers_)
    np.testing.assert_array_equal(got.predict(X), expected.predict(X))


def test_a_solver_that_stops_early_says_so() -> None:
    X, y = rows(60, 4, 2)
    with pytest.warns(ConvergenceWarning, match="L-BFGS stopped"):
        QuickHuber(max_iter=2).fit(X, y)


def test_weights_of_rows_are_scikit_learns() -> None:
    X, y = rows(40, 2, 3)
    weights = np.linspace(0.5, 2.0, 40)
    expected, got = (kind().fit(X, y, weights) for kind in (HuberRegressor, QuickHuber))
    np.testing.assert_array_equal(got.coef_, expected.coef_)


def test_a_solver_that_breaks_down_says_what_scikit_learn_says() -> None:
    X, y = rows(40, 2, 3)
    with pytest.raises(ValueError, match="convergence failed"), np.errstate(all="ignore"):
        QuickHuber().fit(1e200 * X, 1e200 * y)
