"""What every point model of the registry must do."""

from __future__ import annotations

import copy
import io
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Self

import joblib
import numpy as np
import pytest
from sklearn.base import BaseEstimator
from sklearn.linear_model import LinearRegression

from softkin.core.samples import Array, Params, Samples
from softkin.models import MODELS
from softkin.models.spec import ModelSpec
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.training.predict import spread_of
from tests.conftest import bending_arm
from tests.contract import laws

FAMILIES = ("linear", "ensemble", "kernel", "neural network")


def fitted(spec: ModelSpec, params: Params, samples: Samples, seed: int = 0) -> Any:
    return fitted_model(spec, FitSettings(params, skip_constant=True, seed=seed, threads=1), samples)


def is_named(name: str, spec: ModelSpec) -> None:
    laws.has_name_and_title(name, spec)
    assert spec.family in FAMILIES
    assert spec.spread is not None or not spec.is_predictive


def has_sound_parameters(_name: str, spec: ModelSpec) -> None:
    laws.first_trials_lie_in_the_search_space(spec)
    laws.parameters_are_json(spec)


def predicts_all_coordinates_within_the_workspace(_name: str, spec: ModelSpec) -> None:
    """Three commands, three markers, the first of which never moves; by either kind of preset."""
    samples, probe = (bending_arm(n, n_commands=3, n_markers=3, seed=n) for n in (80, 30))
    size = np.abs(probe.positions - samples.positions.mean(axis=0)).mean()
    for params in (spec.paper_params, laws.first_params(spec)[-1]):
        predicted = fitted(spec, params, samples).predict(probe.commands)
        assert predicted.shape == (30, 9)
        assert np.isfinite(predicted).all()
    assert np.abs(predicted - probe.positions).mean() < 0.6 * size


def fits_a_robot_of_one_moving_coordinate(_name: str, spec: ModelSpec) -> None:
    samples, probe = (bending_arm(n, seed=n) for n in (80, 30))
    for rows in (samples, probe):
        rows.positions[:, 1:] = 5.0
    size = np.abs(probe.positions[:, 0] - samples.positions[:, 0].mean()).mean()
    for params in (spec.paper_params, *laws.first_params(spec)):
        predicted = fitted(spec, params, samples).predict(probe.commands)
        np.testing.assert_array_equal(predicted[:, 1:], 5.0)
        assert np.abs(predicted - probe.positions)[:, 0].mean() < size


def repeats_itself_under_a_seed(_name: str, spec: ModelSpec) -> None:
    """To the bit, whatever numpy's global random state is, which scikit-learn itself draws from."""
    samples, probe = bending_arm(60), bending_arm(20, seed=1)
    for params in (spec.paper_params, laws.first_params(spec)[0]):
        passed, predicted = copy.deepcopy(params), []
        for state in (1, 2):
            np.random.seed(state)
            with laws.inputs_kept(samples, probe):
                predicted.append(fitted(spec, passed, samples).predict(probe.commands))
        np.testing.assert_array_equal(predicted[0], predicted[1])
        assert passed == params


def is_the_same_when_stored(_name: str, spec: ModelSpec) -> None:
    samples, probe = bending_arm(60), bending_arm(20, seed=1)
    estimator, file = fitted(spec, laws.first_params(spec)[0], samples), io.BytesIO()
    joblib.dump(estimator, file)
    file.seek(0)
    np.testing.assert_array_equal(joblib.load(file).predict(probe.commands), estimator.predict(probe.commands))


def fits_at_any_point_of_its_search_space(_name: str, spec: ModelSpec) -> None:
    samples, probe = bending_arm(40), bending_arm(10, seed=1)
    for params in laws.drawn_params(spec, 6):
        assert np.isfinite(fitted(spec, params, samples).predict(probe.commands)).all()


def refuses_targets_that_are_no_numbers(_name: str, spec: ModelSpec) -> None:
    samples = bending_arm(40)
    targets = samples.positions / 100.0
    targets[3, 1] = np.nan
    laws.refuses_to_fit(spec.build(dict(spec.paper_params), 0, 1), samples.commands, targets)


def has_a_spread_in_mm(_name: str, spec: ModelSpec) -> None:
    """Positive where the robot moves, 0 at the base, and as large as the robot is."""
    if spec.spread is None:
        return
    samples, probe = (bending_arm(n, n_commands=3, n_markers=3, seed=n) for n in (80, 30))
    means = []
    for factor in (1.0, 8.0):  # a power of two: standardised, the numbers are the same to the bit
        rows = Samples(samples.commands, factor * samples.positions)
        estimator = fitted(spec, laws.first_params(spec)[0], rows)
        with laws.inputs_kept(rows, probe):
            spread = spread_of(spec, estimator, rows, probe.commands)
        assert spread.shape == (30, 9)
        assert (spread[:, :3] == 0).all()
        assert (spread[:, 3:] > 0).all()
        means.append(spread[:, 3:].mean())
    assert means[1] == pytest.approx(8 * means[0], rel=1e-6)


def is_not_moved_by_gross_errors_if_robust(_name: str, spec: ModelSpec) -> None:
    """Three of 80 rows are a metre off: predictions move by a small share of the robot's size."""
    if not spec.is_robust:
        return
    samples, probe = bending_arm(80), bending_arm(30, seed=1)
    damaged = Samples(samples.commands, samples.positions.copy())
    damaged.positions[[5, 30, 70]] += 1000.0
    params = laws.first_params(spec)[0]
    clean, other = (fitted(spec, params, rows).predict(probe.commands) for rows in (samples, damaged))
    assert np.abs(clean - other).mean() < 0.1 * samples.positions.std(axis=0).max()


LAWS = (
    is_named,
    has_sound_parameters,
    predicts_all_coordinates_within_the_workspace,
    fits_a_robot_of_one_moving_coordinate,
    repeats_itself_under_a_seed,
    is_the_same_when_stored,
    fits_at_any_point_of_its_search_space,
    refuses_targets_that_are_no_numbers,
    has_a_spread_in_mm,
    is_not_moved_by_gross_errors_if_robust,
)


def check_model(name: str, spec: ModelSpec) -> None:
    for law in LAWS:
        law(name, spec)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", MODELS)
def test_every_model_keeps_the_contract(name: str, law: Callable[[str, ModelSpec], None]) -> None:
    law(name, MODELS[name])


Change = Callable[[Array], Array]


class Broken(BaseEstimator):  # type: ignore[misc]
    """A linear model whose targets and predictions something changes."""

    def __init__(self, targets: Change, predictions: Change) -> None:
        self.targets = targets
        self.predictions = predictions

    def fit(self, X: Array, y: Array) -> Self:
        self.regressor_ = LinearRegression().fit(X, self.targets(y))
        return self

    def predict(self, X: Array) -> Array:
        return self.predictions(self.regressor_.predict(X))


def built(targets: Change = np.asarray, predictions: Change = np.asarray) -> dict[str, Any]:
    return {"build": lambda *_: Broken(targets, predictions)}


def noisy(predicted: Array) -> Array:
    return predicted + 1e-9 * np.random.default_rng().standard_normal()


def noisy_by_the_global_state(predicted: Array) -> Array:
    return predicted + 1e-9 * np.random.standard_normal()


def wrong_if_flat(predicted: Array) -> Array:
    return predicted + 9.0 if predicted.ndim == 1 else predicted


def eating_its_parameters(params: Params, seed: int, _: int) -> Any:
    params["seed"] = seed
    return LinearRegression()


@pytest.mark.parametrize(
    ("law", "model", "fault"),
    [
        (is_named, "lr", {"name": "linear"}),
        (is_named, "lr", {"family": "unknown"}),
        (has_sound_parameters, "ridge", {"first_trials": ({"degree": 2, "alpha": 1e-3, "no_such": 1.0},)}),
        (has_sound_parameters, "lr", {"paper_params": {"shape": (2, 3)}}),
        (predicts_all_coordinates_within_the_workspace, "lr", built(predictions=np.zeros_like)),
        (fits_a_robot_of_one_moving_coordinate, "lr", built(predictions=wrong_if_flat)),
        (repeats_itself_under_a_seed, "lr", built(predictions=noisy)),
        (repeats_itself_under_a_seed, "lr", built(predictions=noisy_by_the_global_state)),
        (repeats_itself_under_a_seed, "lr", {"build": eating_its_parameters, "paper_params": {}}),
        (is_the_same_when_stored, "lr", built(predictions=noisy)),
        (refuses_targets_that_are_no_numbers, "lr", built(targets=np.nan_to_num)),
        (has_a_spread_in_mm, "gp", {"spread": lambda *of: np.zeros((len(of[-1]), 6))}),
        (is_not_moved_by_gross_errors_if_robust, "lr", {"is_robust": True}),
    ],
)
def test_the_contract_is_broken_by(law: Callable[[str, ModelSpec], None], model: str, fault: dict[str, Any]) -> None:
    spec = replace(MODELS[model], **fault)
    for check in (law, check_model):
        with pytest.raises(AssertionError):
            check(model, spec)
