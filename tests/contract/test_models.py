"""What every model of the registry must do."""

from __future__ import annotations

import io
import json

import joblib
import numpy as np
import optuna
import pytest

from softkin.core.samples import Params, Samples
from softkin.models import MODELS, source_files
from softkin.training.fit import fit_quietly, kinematic_model, spread_of
from tests.conftest import bending_arm

optuna.logging.set_verbosity(optuna.logging.WARNING)


def first_params(model: str) -> list[Params]:
    """The parameters of the first trials, as the search space completes them."""
    spec = MODELS[model]
    return [spec.search_space(optuna.trial.FixedTrial(dict(start))) for start in spec.first_trials]


def fitted_prediction(model: str, params: Params, samples: Samples, probe: Samples, seed: int = 0) -> np.ndarray:
    estimator = kinematic_model(MODELS[model], params, skip_constant=True, seed=seed, threads=1)
    fit_quietly(estimator, samples, 1)
    return np.asarray(estimator.predict(probe.commands))


@pytest.mark.parametrize("model", MODELS)
def test_it_is_registered_under_its_own_name(model: str) -> None:
    assert MODELS[model].name == model
    assert MODELS[model].title
    assert MODELS[model].family in ("linear", "ensemble", "kernel", "neural network")
    assert all(path.is_file() for path in source_files(model))


@pytest.mark.parametrize("model", MODELS)
def test_both_presets_predict_all_coordinates_within_the_workspace(model: str) -> None:
    """Three commands, seven markers, the first of which never moves."""
    samples, probe = (bending_arm(n, n_commands=3, n_markers=7, seed=n) for n in (80, 30))
    spread = np.abs(probe.positions - samples.positions.mean(axis=0)).mean()
    for params in ({**MODELS[model].paper_params}, first_params(model)[-1]):
        predicted = fitted_prediction(model, params, samples, probe)
        assert predicted.shape == (30, 21)
        assert np.isfinite(predicted).all()
    assert np.abs(predicted - probe.positions).mean() < 0.6 * spread


@pytest.mark.parametrize("model", MODELS)
def test_the_same_seed_gives_the_same_prediction_to_the_bit(model: str) -> None:
    samples, probe = bending_arm(60), bending_arm(20, seed=1)
    for params in ({**MODELS[model].paper_params}, first_params(model)[0]):
        one, two = (fitted_prediction(model, params, samples, probe) for _ in range(2))
        np.testing.assert_array_equal(one, two)


@pytest.mark.parametrize("model", MODELS)
def test_a_stored_model_predicts_the_same(model: str) -> None:
    samples, probe = bending_arm(60), bending_arm(20, seed=1)
    estimator = kinematic_model(MODELS[model], first_params(model)[0], skip_constant=True, seed=0, threads=1)
    fit_quietly(estimator, samples, 1)
    file = io.BytesIO()
    joblib.dump(estimator, file)
    file.seek(0)
    np.testing.assert_array_equal(joblib.load(file).predict(probe.commands), estimator.predict(probe.commands))


@pytest.mark.parametrize("model", MODELS)
def test_any_point_of_the_search_space_can_be_fitted_and_stored(model: str) -> None:
    samples, probe = bending_arm(40), bending_arm(10, seed=1)
    study = optuna.create_study(sampler=optuna.samplers.RandomSampler(seed=0))
    for _ in range(6):
        params = MODELS[model].search_space(study.ask())
        assert json.loads(json.dumps(params)) == params
        assert np.isfinite(fitted_prediction(model, params, samples, probe)).all()


@pytest.mark.parametrize("model", MODELS)
def test_the_first_trials_lie_inside_the_search_space(model: str) -> None:
    spec = MODELS[model]
    for start in spec.first_trials:
        study = optuna.create_study(sampler=optuna.samplers.RandomSampler(seed=0))
        study.enqueue_trial(dict(start))
        trial = study.ask()
        spec.search_space(trial)
        assert trial.params == start
        for name, distribution in trial.distributions.items():
            assert distribution._contains(distribution.to_internal_repr(start[name])), name


@pytest.mark.parametrize("model", [name for name, spec in MODELS.items() if spec.spread is not None])
def test_a_spread_is_in_mm_positive_and_grows_with_the_robot(model: str) -> None:
    samples, probe = bending_arm(80, n_commands=3, n_markers=3), bending_arm(30, n_commands=3, n_markers=3, seed=1)
    means = []
    for factor in (1.0, 8.0):  # a power of two: standardised, the numbers are the same to the bit
        rows = Samples(samples.commands, factor * samples.positions)
        estimator = kinematic_model(MODELS[model], first_params(model)[0], skip_constant=True, seed=0, threads=1)
        fit_quietly(estimator, rows, 1)
        spread = spread_of(MODELS[model], estimator, rows, probe.commands)
        assert spread.shape == (30, 9)
        assert (spread[:, :3] == 0).all()  # the base never moves
        assert (spread[:, 3:] > 0).all()
        means.append(spread[:, 3:].mean())
    assert means[1] == pytest.approx(8 * means[0], rel=1e-6)
