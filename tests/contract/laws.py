"""What the entries of every registry promise alike."""

from __future__ import annotations

import json
import pickle
import random
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import optuna
from numpy.typing import NDArray

from softkin.core.samples import Array, Params
from softkin.models.quantile.spec import QuantileSpec
from softkin.models.spec import ModelSpec

optuna.logging.set_verbosity(optuna.logging.WARNING)


def has_name_and_title(name: str, entry: Any) -> None:
    """The entry bears the name that it is registered under, and a title for people."""
    assert entry.name == name
    assert entry.title.strip()


@contextmanager
def inputs_kept(*inputs: object) -> Iterator[None]:
    """The block leaves the arrays of its `inputs` as they are."""
    before = [array.copy() for array in arrays(inputs)]
    yield
    for old, new in zip(before, arrays(inputs), strict=True):
        np.testing.assert_array_equal(old, new, "an input was modified")


@contextmanager
def global_random_states_kept() -> Iterator[None]:
    """The block neither seeds nor uses the random states that a whole process shares."""
    np.random.seed(17)
    random.seed(17)
    states = pickle.dumps((np.random.get_state(), random.getstate()))
    yield
    assert pickle.dumps((np.random.get_state(), random.getstate())) == states, "a global random state was touched"


def arrays(value: object) -> list[NDArray[Any]]:
    """All arrays in nested dataclasses, mappings and sequences."""
    if isinstance(value, np.ndarray):
        return [value]
    if is_dataclass(value):
        value = [getattr(value, field.name) for field in fields(value)]
    if isinstance(value, Mapping):
        value = list(value.values())
    return [array for part in value for array in arrays(part)] if isinstance(value, (list, tuple)) else []


def drawn_params(spec: ModelSpec | QuantileSpec, n_trials: int) -> Iterator[Params]:
    """Parameters of random trials of the search space."""
    study = optuna.create_study(sampler=optuna.samplers.RandomSampler(seed=0))
    for _ in range(n_trials):
        yield spec.search_space(study.ask())


def first_params(spec: ModelSpec | QuantileSpec) -> list[Params]:
    """The parameters of the first trials, as the search space completes them."""
    return [spec.search_space(optuna.trial.FixedTrial(dict(start))) for start in spec.first_trials]


def parameters_are_json(spec: ModelSpec | QuantileSpec) -> None:
    """Parameters of the paper and of any trial survive a record in JSON."""
    for params in (spec.paper_params, *drawn_params(spec, 6)):
        assert json.loads(json.dumps(params)) == params


def first_trials_lie_in_the_search_space(spec: ModelSpec | QuantileSpec) -> None:
    """The first trials name each parameter that is drawn, within its bounds."""
    assert spec.first_trials
    for start in spec.first_trials:
        study = optuna.create_study(sampler=optuna.samplers.RandomSampler(seed=0))
        study.enqueue_trial(dict(start))
        trial = study.ask()
        spec.search_space(trial)
        assert trial.params == start
        for name, distribution in trial.distributions.items():
            assert distribution._contains(distribution.to_internal_repr(start[name])), name


def refuses_to_fit(regressor: Any, commands: Array, targets: Array) -> None:
    """Fitting to these rows is an error."""
    try:
        regressor.fit(commands, targets)
    except ValueError:
        return
    raise AssertionError("fitted to what are no numbers")
