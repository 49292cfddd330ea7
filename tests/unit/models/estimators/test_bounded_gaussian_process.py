from __future__ import annotations

import numpy as np
import pytest
from sklearn.base import clone
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import DotProduct, WhiteKernel
from sklearn.linear_model import LinearRegression

from softkin.models.estimators.bounded_gaussian_process import BoundedGaussianProcess
from tests.conftest import bending_arm


def standardised(n: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    rows = bending_arm(n, seed=seed)
    return rows.commands, (rows.positions - rows.positions.mean(0)) / rows.positions.std(0)


def test_the_posterior_is_scikit_learns_and_the_likelihood_as_good() -> None:
    x, y = standardised(60)
    ours = BoundedGaussianProcess("none", "paper_linear", learning_rows=60, max_iter=200).fit(x, y)
    learnt = ours.posterior_.kernel_
    same_kernel = GaussianProcessRegressor(learnt, optimizer=None).fit(x, y)
    np.testing.assert_allclose(ours.predict(x), same_kernel.predict(x), atol=1e-10)
    theirs = GaussianProcessRegressor(DotProduct() + WhiteKernel()).fit(x, y)
    likelihood = theirs.log_marginal_likelihood
    assert likelihood(learnt.theta) >= likelihood(theirs.kernel_.theta) - 1.0  # of 173 nats


def test_the_search_does_not_stop_where_it_started() -> None:
    """Unscaled, the first step of L-BFGS lands on the bounds, where the kernel is singular: the search ends."""
    x, y = standardised(150)
    model = BoundedGaussianProcess("rbf", learning_rows=150).fit(x, y)
    start = model._kernel(2).theta
    assert np.abs(model.posterior_.kernel_.theta - start).min() > 0.01


def test_the_papers_kernel_is_a_linear_model() -> None:
    x, y = standardised(200)
    ours = BoundedGaussianProcess("none", "paper_linear", learning_rows=200, max_iter=200).fit(x, y)
    np.testing.assert_allclose(ours.predict(x), LinearRegression().fit(x, y).predict(x), atol=0.06)


@pytest.mark.parametrize("trend", ["none", "linear", "quadratic"])
@pytest.mark.parametrize("kernel", ["rbf", "matern32", "matern52", "rational_quadratic"])
def test_every_kernel_learns_on_few_rows_and_conditions_on_all(kernel: str, trend: str) -> None:
    x, y = standardised(150)
    model = BoundedGaussianProcess(kernel, trend, learning_rows=50, max_iter=30).fit(x, y)
    assert model.posterior_.X_train_.shape == (150, 2)
    probe_x, probe_y = standardised(50, seed=1)
    assert np.abs(model.predict(probe_x) - probe_y).mean() < 0.15


def test_a_length_scale_per_command() -> None:
    x, y = standardised(150)
    x = np.column_stack([x, np.random.default_rng(0).uniform(-1, 1, 150)])  # a command without influence
    model = BoundedGaussianProcess("rbf", learning_rows=150, max_iter=60).fit(x, y)
    scales = model.posterior_.kernel_.k1.k2.length_scale
    assert scales[2] > 5 * max(scales[:2])


def test_repeated_rows_do_not_break_the_factorisation() -> None:
    x, y = standardised(10)
    x, y = np.tile(x, (30, 1)), np.tile(y, (30, 1))
    model = BoundedGaussianProcess(initial_noise=1e-8, learning_rows=300).fit(x, y)
    assert np.abs(model.predict(x) - y).max() < 0.05


def test_it_is_a_scikit_learn_estimator() -> None:
    model = BoundedGaussianProcess("matern32", "linear", random_state=4)
    assert clone(model).get_params() == model.get_params()


def test_the_standard_deviation_holds_its_share_of_new_rows_in_every_coordinate() -> None:
    """Two coordinates share a kernel, and each has a factor of its own."""
    rng = np.random.default_rng(0)
    X = rng.uniform(-1, 1, (500, 2))
    clean = np.column_stack([np.sin(2 * X[:, 0]), X[:, 0] * X[:, 1]])
    y = clean / clean.std(axis=0) + rng.standard_normal(clean.shape) * 0.3
    model = BoundedGaussianProcess(max_iter=30).fit(X[:300], y[:300])
    std = model.predict_std(X[300:])
    assert std.shape == (200, 2)
    held = np.abs(y[300:] - model.predict(X[300:])) <= 1.645 * std
    assert held.mean(axis=0) == pytest.approx([0.9, 0.9], abs=0.06)
    scaled = BoundedGaussianProcess(max_iter=30).fit(X[:300], y[:300] * [1.0, 10.0])
    assert scaled.predict_std(X[300:])[:, 1].mean() > 5 * scaled.predict_std(X[300:])[:, 0].mean()


@pytest.mark.parametrize("bounds", [{"ROWS_AT_ONCE": 10}, {"MANY_ROWS": 39, "PART": 10}], ids=["few", "many"])
def test_many_rows_are_predicted_in_parts(bounds: dict[str, int], monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(0)
    X, y = rng.uniform(-1, 1, (40, 2)), rng.standard_normal((40, 3))
    model = BoundedGaussianProcess(max_iter=2).fit(X, y)
    new = rng.uniform(-1, 1, (25, 2))
    whole = model.predict(new), model.predict_std(new)
    for name, value in bounds.items():
        monkeypatch.setattr(f"softkin.models.estimators.bounded_gaussian_process.{name}", value)
    assert [len(part) for part in model._parts(new)] == [9, 8, 8]
    for once, parts in zip(whole, (model.predict(new), model.predict_std(new)), strict=True):
        np.testing.assert_allclose(parts, once, rtol=1e-10)
