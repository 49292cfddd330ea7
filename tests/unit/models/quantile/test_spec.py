from __future__ import annotations

from collections.abc import Sequence
from dataclasses import FrozenInstanceError

import pytest
from sklearn.linear_model import QuantileRegressor
from sklearn.multioutput import MultiOutputRegressor

from softkin.core.samples import Params
from softkin.models.quantile.spec import QuantileSpec


def build(params: Params, quantiles: Sequence[float], *_: int) -> MultiOutputRegressor:
    return MultiOutputRegressor(QuantileRegressor(quantile=quantiles[0], **params))


SPEC = QuantileSpec("line", "Straight line", build, {"alpha": 0.0}, lambda _: {}, ({},))


def test_its_regressor_is_built_for_the_quantiles_that_are_asked_for() -> None:
    assert SPEC.build(SPEC.paper_params, [0.25], 0, 1).estimator.get_params()["quantile"] == 0.25


def test_a_spec_is_frozen() -> None:
    with pytest.raises(FrozenInstanceError):
        SPEC.name = "other"  # type: ignore[misc]
