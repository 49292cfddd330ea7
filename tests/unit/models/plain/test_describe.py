from __future__ import annotations

import numpy as np
import pytest
from sklearn.dummy import DummyRegressor
from sklearn.linear_model import HuberRegressor, LinearRegression

from softkin.core.errors import ConfigError
from softkin.models.estimators.bounded_polynomial import BoundedPolynomial
from softkin.models.estimators.quick_huber import QuickHuber
from softkin.models.plain.describe import described, numbers_in
from softkin.models.plain.evaluate import regressor
from softkin.models.plain.kernels import Node

X = np.random.default_rng(0).normal(size=(30, 2))


def test_a_class_without_a_describer_is_named() -> None:
    with pytest.raises(ConfigError, match="a DummyRegressor cannot be written as plain numbers"):
        described(DummyRegressor().fit(X, X))


def test_powers_without_products_are_described() -> None:
    from sklearn.pipeline import make_pipeline

    model = make_pipeline(BoundedPolynomial(3, interactions=False), LinearRegression()).fit(X, X[:, 0] ** 3)
    np.testing.assert_allclose(regressor(described(model))(X)[0][:, 0], model.predict(X), atol=1e-12)


@pytest.mark.parametrize("robust", [HuberRegressor, QuickHuber])
def test_robust_regressors_of_this_version_and_earlier_ones_are_described(robust: type[HuberRegressor]) -> None:
    model = robust().fit(X, X[:, 0])
    np.testing.assert_allclose(regressor(described(model))(X)[0][:, 0], model.predict(X), atol=1e-12)


def test_numbers_are_counted() -> None:
    node: Node = {"kind": "mean", "members": [{"weights": np.zeros((3, 4))}], "single": True}
    assert numbers_in(node) == 1 + 12 + 1
