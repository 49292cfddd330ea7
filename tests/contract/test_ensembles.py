"""What every ensemble of the registry must do."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.models.ensembles.spec import EnsembleSpec
from tests.contract import laws

N_RUNS, N_ROWS = 6, 40


def held_out(seed: int, n_runs: int = N_RUNS, n_coordinates: int = 3) -> tuple[Array, Array, Array]:
    """What runs predict, each with errors of its own and some that all share; truth; shares of rows of two parts."""
    rng = np.random.default_rng(seed)
    truth = 10 * rng.standard_normal((N_ROWS, n_coordinates))
    shared = rng.standard_normal(truth.shape)
    sizes = rng.uniform(0.5, 3.0, n_runs)[:, None, None]
    predicted = truth + sizes * (0.5 * shared + rng.standard_normal((n_runs, *truth.shape)))
    return predicted, truth, np.repeat([0.5 / 30, 0.5 / 10], [30, 10])


def errors(weights: Array, predicted: Array, truth: Array, shares: Array) -> Array:
    """Mean absolute error (n_steps,) of each step."""
    means = np.tensordot(weights, predicted, axes=1)
    return np.asarray(np.abs(means - truth).mean(axis=2) @ shares)


def is_named(name: str, spec: EnsembleSpec) -> None:
    laws.has_name_and_title(name, spec)
    assert spec.family == "ensemble"
    assert name not in MODELS, "a run is told by its name"
    assert spec.spread is None
    assert pickle.loads(pickle.dumps(spec)) == spec, "a calibrated model holds it"


def weights_are_shares(_name: str, spec: EnsembleSpec) -> None:
    for seed in range(4):
        weights = spec.steps(*held_out(seed))
        assert weights.shape[1] == N_RUNS
        assert (weights >= 0).all()
        np.testing.assert_allclose(weights.sum(axis=1), 1.0, rtol=1e-12)


def begins_with_the_best_run_alone(_name: str, spec: EnsembleSpec) -> None:
    """So the best step is never worse than the best run."""
    for seed in range(4):
        data = held_out(seed)
        alone = errors(np.eye(N_RUNS), *data)
        weights = spec.steps(*data)
        np.testing.assert_array_equal(weights[0], np.eye(N_RUNS)[np.argmin(alone)])
        assert errors(weights, *data).min() <= alone.min()


def is_better_where_errors_differ(_name: str, spec: EnsembleSpec) -> None:
    for seed in range(4):
        data = held_out(seed)
        assert errors(spec.steps(*data), *data).min() < 0.97 * errors(np.eye(N_RUNS), *data).min()


def takes_one_run_and_equal_runs(_name: str, spec: EnsembleSpec) -> None:
    predicted, truth, shares = held_out(0)
    assert (spec.steps(predicted[:1], truth, shares) == 1.0).all()
    same = spec.steps(np.repeat(predicted[:1], 3, axis=0), truth, shares)
    assert same[0].tolist() == [1.0, 0.0, 0.0], "of equal runs the first"


def counts_rows_by_their_shares(_name: str, spec: EnsembleSpec) -> None:
    """A run that is right where shares are not 0 is the whole ensemble."""
    predicted, truth, _ = held_out(1)
    predicted[4, :5] = truth[:5]
    weights = spec.steps(predicted, truth, np.r_[np.full(5, 0.2), np.zeros(N_ROWS - 5)])
    assert weights[0].tolist() == np.eye(N_RUNS)[4].tolist()


def repeats_itself_and_leaves_its_inputs(_name: str, spec: EnsembleSpec) -> None:
    data = held_out(2)
    with laws.inputs_kept(*data), laws.global_random_states_kept():
        first = spec.steps(*data)
    np.testing.assert_array_equal(first, spec.steps(*data))
    order = np.random.default_rng(0).permutation(N_ROWS)
    predicted, truth, shares = data
    np.testing.assert_allclose(spec.steps(predicted[:, order], truth[order], shares[order]), first, atol=1e-12)


def predicts_with_few_members(_name: str, spec: EnsembleSpec) -> None:
    """A prediction takes as long as those of all members."""
    predicted, truth, shares = held_out(3, n_runs=30)
    assert (spec.steps(predicted, truth, shares) > 0).sum(axis=1).max() <= 5


LAWS = (
    is_named,
    weights_are_shares,
    begins_with_the_best_run_alone,
    is_better_where_errors_differ,
    takes_one_run_and_equal_runs,
    counts_rows_by_their_shares,
    repeats_itself_and_leaves_its_inputs,
    predicts_with_few_members,
)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", ENSEMBLES)
def test_every_ensemble_keeps_the_contract(name: str, law: Callable[[str, EnsembleSpec], None]) -> None:
    law(name, ENSEMBLES[name])


def plain_mean(predicted: Array, *_: Array) -> Array:
    return np.full((1, len(predicted)), 1 / len(predicted))


def best_alone(predicted: Array, truth: Array, shares: Array) -> Array:
    return np.eye(len(predicted))[[np.argmin(errors(np.eye(len(predicted)), predicted, truth, shares))]]


def drawn(predicted: Array, truth: Array, shares: Array) -> Array:
    return np.vstack([best_alone(predicted, truth, shares), np.random.dirichlet(np.ones(len(predicted)), 4)])


def twice(predicted: Array, truth: Array, shares: Array) -> Array:
    return 2 * best_alone(predicted, truth, shares)


def changing(predicted: Array, truth: Array, shares: Array) -> Array:
    predicted += 1.0
    return best_alone(predicted, truth, shares)


@pytest.mark.parametrize(
    ("law", "steps"),
    [
        (weights_are_shares, twice),
        (begins_with_the_best_run_alone, plain_mean),
        (is_better_where_errors_differ, best_alone),
        (takes_one_run_and_equal_runs, plain_mean),
        (counts_rows_by_their_shares, plain_mean),
        (repeats_itself_and_leaves_its_inputs, drawn),
        (repeats_itself_and_leaves_its_inputs, changing),
        (predicts_with_few_members, plain_mean),
    ],
)
def test_the_contract_is_broken_by(
    law: Callable[[str, EnsembleSpec], None], steps: Callable[[Array, Array, Array], Array]
) -> None:
    name = next(iter(ENSEMBLES))
    with pytest.raises(AssertionError):
        law(name, replace(ENSEMBLES[name], steps=steps))
