"""What every quantile regressor of the registry must do."""

from __future__ import annotations

import copy
import io
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Self

import joblib
import numpy as np
import pytest
from sklearn.base import BaseEstimator

from softkin.core.samples import Array, Params
from softkin.models.quantile import QUANTILE_MODELS
from softkin.models.quantile.spec import QuantileSpec
from tests.contract import laws

QUANTILES = (0.1, 0.9)


def rows(n: int, seed: int) -> tuple[Array, Array]:
    """Commands (n_rows, 2) and one coordinate (n_rows,), both standardised, noise that grows with the first command."""
    rng = np.random.default_rng(seed)
    commands = rng.uniform(-1.7, 1.7, (n, 2))
    return commands, 0.7 * commands[:, 0] + 0.1 * (2 + commands[:, 0]) * rng.standard_normal(n)


def fitted(spec: QuantileSpec, params: Params, n: int = 60, seed: int = 0) -> Any:
    return spec.build(params, QUANTILES, seed, 1).fit(*rows(n, 0))


def is_named(name: str, spec: QuantileSpec) -> None:
    laws.has_name_and_title(name, spec)


def has_sound_parameters(_name: str, spec: QuantileSpec) -> None:
    laws.first_trials_lie_in_the_search_space(spec)
    laws.parameters_are_json(spec)


def predicts_each_of_its_quantiles(_name: str, spec: QuantileSpec) -> None:
    """About the share of the rows it is fitted on lies below each; with the paper's settings and those of a trial."""
    commands, coordinate = rows(400, 0)
    for params in (spec.paper_params, laws.first_params(spec)[-1]):
        predicted = np.asarray(fitted(spec, params, 400).predict(commands))
        assert predicted.shape == (400, 2)
        shares = (coordinate[:, None] <= predicted).mean(axis=0)
        assert np.abs(shares - QUANTILES).max() < 0.1
        assert (np.diff(predicted.mean(axis=0)) > 0).all()


def repeats_itself_under_a_seed(_name: str, spec: QuantileSpec) -> None:
    """To the bit, whatever numpy's global random state is, which scikit-learn itself draws from."""
    (commands, coordinate), probe = rows(60, 0), rows(20, 1)[0]
    for params in (spec.paper_params, laws.first_params(spec)[0]):
        passed, predicted = copy.deepcopy(params), []
        for state in (1, 2):
            np.random.seed(state)
            with laws.inputs_kept(commands, coordinate, probe):
                regressor = spec.build(passed, QUANTILES, 0, 1).fit(commands, coordinate)
                predicted.append(np.asarray(regressor.predict(probe)))
        np.testing.assert_array_equal(predicted[0], predicted[1])
        assert passed == params


def is_the_same_when_stored(_name: str, spec: QuantileSpec) -> None:
    regressor, file, probe = fitted(spec, laws.first_params(spec)[0]), io.BytesIO(), rows(20, 1)[0]
    joblib.dump(regressor, file)
    file.seek(0)
    np.testing.assert_array_equal(joblib.load(file).predict(probe), regressor.predict(probe))


def fits_at_any_point_of_its_search_space(_name: str, spec: QuantileSpec) -> None:
    for params in laws.drawn_params(spec, 3):
        assert np.isfinite(fitted(spec, params, 40).predict(rows(10, 1)[0])).all()


def refuses_targets_that_are_no_numbers(_name: str, spec: QuantileSpec) -> None:
    commands, coordinate = rows(40, 0)
    coordinate[3] = np.nan
    laws.refuses_to_fit(spec.build(dict(spec.paper_params), QUANTILES, 0, 1), commands, coordinate)


LAWS = (
    is_named,
    has_sound_parameters,
    predicts_each_of_its_quantiles,
    repeats_itself_under_a_seed,
    is_the_same_when_stored,
    fits_at_any_point_of_its_search_space,
    refuses_targets_that_are_no_numbers,
)


def check_quantile_model(name: str, spec: QuantileSpec) -> None:
    for law in LAWS:
        law(name, spec)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", QUANTILE_MODELS)
def test_every_quantile_regressor_keeps_the_contract(name: str, law: Callable[[str, QuantileSpec], None]) -> None:
    law(name, QUANTILE_MODELS[name])


class Broken(BaseEstimator):  # type: ignore[misc]
    """Predicts the quantiles of all rows, at every command, changed by something."""

    def __init__(self, quantiles: Sequence[float], change: Callable[[Array], Array]) -> None:
        self.quantiles = quantiles
        self.change = change

    def fit(self, X: Array, y: Array) -> Self:  # noqa: ARG002 (scikit-learn's signature)
        self.predicted_ = np.quantile(y, self.quantiles)
        return self

    def predict(self, X: Array) -> Array:
        return self.change(np.tile(self.predicted_, (len(X), 1)))


def noisy(quantiles: Array) -> Array:
    return quantiles + 1e-9 * np.random.default_rng().standard_normal()


def noisy_by_the_global_state(quantiles: Array) -> Array:
    return quantiles + 1e-9 * np.random.standard_normal()


@pytest.mark.parametrize(
    ("law", "change"),
    [
        (predicts_each_of_its_quantiles, lambda quantiles: quantiles[:, ::-1]),
        (predicts_each_of_its_quantiles, lambda quantiles: quantiles[:, 0]),
        (predicts_each_of_its_quantiles, lambda quantiles: np.tile(quantiles.mean(axis=1), (2, 1)).T),
        (repeats_itself_under_a_seed, noisy_by_the_global_state),
        (is_the_same_when_stored, noisy),
        (fits_at_any_point_of_its_search_space, lambda quantiles: quantiles + np.inf),
        (refuses_targets_that_are_no_numbers, np.nan_to_num),
    ],
)
def test_the_contract_is_broken_by(law: Callable[[str, QuantileSpec], None], change: Callable[[Array], Array]) -> None:
    spec = replace(QUANTILE_MODELS["gb"], build=lambda *of: Broken(of[1], change))
    for check in (law, check_quantile_model):
        with pytest.raises(AssertionError):
            check("gb", spec)


def test_another_name_breaks_the_contract() -> None:
    with pytest.raises(AssertionError):
        check_quantile_model("lgb", QUANTILE_MODELS["gb"])
