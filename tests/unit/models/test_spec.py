from __future__ import annotations

from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from sklearn.linear_model import LinearRegression

from softkin.core.runs import PAPER
from softkin.core.samples import Params
from softkin.models import MODELS
from softkin.models.estimators.detrended import detrended
from softkin.models.spec import PAPERS_RUN, TRENDS, ModelSpec


def minimal() -> ModelSpec:
    def build(params: Params, *_: int) -> LinearRegression:
        return LinearRegression(**params)

    return ModelSpec(
        name="mean",
        title="Mean",
        family="linear",
        build=build,
        paper_params={},
        search_space=lambda _: {},
        first_trials=({},),
    )


def test_a_model_need_not_have_a_spread_and_is_neither_cheap_nor_robust_by_default() -> None:
    spec = minimal()
    assert spec.spread is None
    assert (spec.is_predictive, spec.is_cheap, spec.is_robust) == (False, False, False)
    regressor = spec.build({}, 0, 1)
    regressor.fit(np.array([[0.0], [1.0]]), np.array([0.0, 2.0]))
    assert regressor.predict(np.array([[2.0]])) == pytest.approx([4.0])


def test_a_spec_is_frozen() -> None:
    with pytest.raises(FrozenInstanceError):
        minimal().is_cheap = True  # type: ignore[misc]


def test_the_index_of_a_trend_is_its_degree() -> None:
    commands = np.linspace(-1, 1, 30)[:, None]
    targets = commands**2
    errors = []
    for trend in TRENDS:
        fitted = detrended(lambda _: LinearRegression(fit_intercept=False), {"trend": trend}).fit(commands, targets)
        errors.append(np.abs(fitted.predict(commands) - targets).max())
        assert getattr(fitted, "degree", 0) == TRENDS.index(trend)
    assert errors[TRENDS.index("quadratic")] < 1e-12 < errors[TRENDS.index("linear")]


def test_the_papers_run_is_one_of_the_registry() -> None:
    assert PAPERS_RUN.model in MODELS
    assert PAPERS_RUN.preset == PAPER
