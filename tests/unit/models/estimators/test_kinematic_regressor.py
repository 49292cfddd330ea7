from __future__ import annotations

from typing import Self

import numpy as np
import pytest
from sklearn.base import BaseEstimator, TransformerMixin, clone
from sklearn.compose import TransformedTargetRegressor
from sklearn.ensemble import RandomForestRegressor
from sklearn.linear_model import LinearRegression

from softkin.core.samples import Array
from softkin.models.estimators.kinematic_regressor import KinematicRegressor
from softkin.models.estimators.position_scaler import PositionScaler
from tests.conftest import bending_arm


class AroundCommands(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """Subtracts the mean of the commands: no transformer of targets alone could."""

    def fit(self, X: Array, y: Array) -> Self:  # noqa: ARG002 (scikit-learn's signature)
        self.shift_ = y.mean()
        return self

    def transform(self, X: Array) -> Array:
        return X - self.shift_

    def inverse_transform(self, X: Array) -> Array:
        return X + self.shift_


class Shapes(LinearRegression):  # type: ignore[misc]
    """Remembers the shape of its targets."""

    def fit(self, X: Array, y: Array) -> Self:
        self.target_shape_ = y.shape
        return super().fit(X, y)


def test_with_a_transformer_of_targets_alone_it_is_scikit_learns() -> None:
    rows = bending_arm(60)
    forest, scaler = RandomForestRegressor(10, random_state=0), PositionScaler(skip_constant=False)
    ours = KinematicRegressor(forest, scaler).fit(rows.commands, rows.positions)
    theirs = TransformedTargetRegressor(forest, transformer=scaler).fit(rows.commands, rows.positions)
    np.testing.assert_array_equal(ours.predict(rows.commands), theirs.predict(rows.commands))


def test_the_transformer_is_fitted_on_the_commands_too_and_undone_for_predictions() -> None:
    rows = bending_arm(60)
    commands = rows.commands + 7.0
    model = KinematicRegressor(LinearRegression(), AroundCommands()).fit(commands, rows.positions)
    assert model.transformer_.shift_ == pytest.approx(commands.mean())
    expected = LinearRegression().fit(commands, rows.positions).predict(commands)
    np.testing.assert_allclose(model.predict(commands), expected, atol=1e-9)
    np.testing.assert_allclose(model.targets(commands), expected - commands.mean(), atol=1e-9)


@pytest.mark.parametrize(("n_moving", "shape"), [(1, (20,)), (2, (20, 2))])
def test_one_target_is_fitted_as_a_vector_and_predicted_as_a_column(n_moving: int, shape: tuple[int, ...]) -> None:
    rows = bending_arm(20)
    positions = np.column_stack([rows.positions[:, :n_moving], np.full((20, 3 - n_moving), 4.0)])
    model = KinematicRegressor(Shapes(), PositionScaler()).fit(rows.commands, positions)
    assert model.regressor_.target_shape_ == shape
    assert model.targets(rows.commands).shape == (20, n_moving)
    predicted = model.predict(rows.commands)
    assert predicted.shape == (20, 3)
    np.testing.assert_array_equal(predicted[:, n_moving:], 4.0)


def test_a_fit_leaves_regressor_and_transformer_as_they_were() -> None:
    rows = bending_arm(20)
    regressor, scaler = LinearRegression(), PositionScaler()
    model = KinematicRegressor(regressor, scaler).fit(rows.commands, rows.positions)
    assert not hasattr(regressor, "coef_")
    assert not hasattr(scaler, "scaler_")
    assert not hasattr(clone(model), "regressor_")
