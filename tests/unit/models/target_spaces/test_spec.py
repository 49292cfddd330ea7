from __future__ import annotations

from collections.abc import Mapping
from dataclasses import FrozenInstanceError
from typing import Any

import numpy as np
import pytest
from sklearn.linear_model import LinearRegression
from sklearn.preprocessing import FunctionTransformer

from softkin.models.estimators.kinematic_regressor import KinematicRegressor
from softkin.models.target_spaces.spec import TargetSpace


def transformer(*_: bool | Mapping[str, Any] | None) -> FunctionTransformer:
    return FunctionTransformer(np.log, np.exp)


SPACE = TargetSpace("logarithm", "Logarithm", transformer)


def test_a_model_is_fitted_in_the_space_of_its_transformer() -> None:
    """An exponential is a straight line in logarithms."""
    commands = np.linspace(0, 2, 20)[:, None]
    positions = np.exp(commands * [1.0, 2.0, 3.0])
    fitted = KinematicRegressor(LinearRegression(), SPACE.transformer(True, None)).fit(commands, positions)
    np.testing.assert_allclose(fitted.predict(2 * commands), np.exp(2 * commands * [1.0, 2.0, 3.0]), rtol=1e-9)


def test_a_space_is_frozen() -> None:
    with pytest.raises(FrozenInstanceError):
        SPACE.name = "other"  # type: ignore[misc]
