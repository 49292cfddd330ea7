from __future__ import annotations

import json
import warnings
from dataclasses import replace
from typing import Self

import numpy as np
import pytest
from sklearn.linear_model import LinearRegression
from threadpoolctl import threadpool_info

from softkin.core.samples import SUBSETS, TRAIN, Array, Samples
from softkin.models import MODELS
from softkin.training.kinematic_model import (
    FitSettings,
    fit_quietly,
    fitted_model,
    kinematic_model,
    recorded_settings,
)
from tests.conftest import four_subsets

SETTINGS = FitSettings({"degree": 2}, skip_constant=True, seed=0, threads=1)


def test_the_unit_of_the_commands_does_not_matter(samples: Samples) -> None:
    """Commands and positions are standardised by the rows that the model is fitted on."""
    for model in ("lasso", "svr", "mlp"):
        predicted = []
        for factor in (1.0, 1024.0):
            spec = MODELS[model]
            settings = FitSettings({**spec.paper_params}, skip_constant=False, seed=0, threads=1)
            estimator = kinematic_model(spec, settings)
            fit_quietly(estimator, Samples(samples.commands * factor, samples.positions), 1)
            predicted.append(estimator.predict(samples.commands * factor))
        np.testing.assert_allclose(predicted[0], predicted[1], rtol=1e-6)


def test_solvers_stopped_at_their_bound_are_counted(samples: Samples) -> None:
    spec = MODELS["svr"]
    bounded = {"kernel": "rbf", "C": 100.0, "epsilon": 1e-3, "gamma": 1.0, "max_iter": 2}
    estimator = kinematic_model(spec, replace(SETTINGS, params=bounded))
    assert fit_quietly(estimator, samples, 1) == 3
    free = kinematic_model(spec, replace(SETTINGS, params={}))
    assert fit_quietly(free, samples, 1) == 0


def test_other_warnings_of_a_fit_go_to_the_log_once_each(samples: Samples, caplog: pytest.LogCaptureFixture) -> None:
    class Warning_(LinearRegression):  # type: ignore[misc]
        def fit(self, X: Array, y: Array) -> Self:
            for _ in range(3):
                warnings.warn("the matrix is singular", RuntimeWarning, stacklevel=1)
            return super().fit(X, y)

    assert fit_quietly(Warning_(), samples, 1) == 0
    assert [record.message for record in caplog.records] == ["the matrix is singular"]


def test_a_fit_takes_no_more_threads_than_it_is_allowed(samples: Samples) -> None:
    class Counting(LinearRegression):  # type: ignore[misc]
        def fit(self, X: Array, y: Array) -> Self:
            self.threads_ = {pool["num_threads"] for pool in threadpool_info()}
            return super().fit(X, y)

    model = Counting()
    fit_quietly(model, samples, 1)
    assert model.threads_ == {1}


def test_a_coordinate_that_never_varies_is_predicted_exactly() -> None:
    rows = four_subsets(dict.fromkeys(SUBSETS, 40), n_commands=3, n_markers=2)[TRAIN]
    estimator = fitted_model(MODELS["mlp"], replace(SETTINGS, params={**MODELS["mlp"].paper_params}), rows)
    np.testing.assert_array_equal(estimator.predict(rows.commands)[:, :3], rows.positions[:, :3])


@pytest.mark.parametrize("target_space", ["cartesian", "curvature"])
def test_a_recorded_fit_is_repeated_to_the_bit(samples: Samples, target_space: str) -> None:
    """Whatever decides a fit stands in its record, or is the seed and the threads of the job."""
    base = {"origin": [0.0, 0.0, -1.0], "axis": [0.0, 0.0, 1.0]}
    settings = FitSettings({"n_estimators": 5}, True, seed=3, threads=1, target_space=target_space, base=base)
    record = {
        "params": settings.params,
        "skip_constant": settings.skip_constant,
        "target_space": settings.target_space,
        "base": settings.base,
        "memory": settings.memory,
        "fit_seconds": 1.0,
    }
    again = recorded_settings(json.loads(json.dumps(record)), seed=3, threads=1)
    assert again == settings
    one, two = (fitted_model(MODELS["rf"], each, samples).predict(samples.commands) for each in (settings, again))
    np.testing.assert_array_equal(one, two)
    other = recorded_settings(record, seed=4, threads=1)
    assert not np.array_equal(fitted_model(MODELS["rf"], other, samples).predict(samples.commands), one)


def test_a_model_is_fitted_in_the_target_space_and_around_the_base_of_its_settings(samples: Samples) -> None:
    base = {"origin": [0.0, 0.0, -2.0], "axis": [0.0, 0.0, 1.0]}
    estimator = fitted_model(MODELS["lr"], replace(SETTINGS, target_space="curvature", base=base), samples)
    np.testing.assert_array_equal(estimator.transformer_.frame_.origin, base["origin"])
    in_positions = fitted_model(MODELS["lr"], SETTINGS, samples)
    assert not np.allclose(estimator.predict(samples.commands), in_positions.predict(samples.commands))
