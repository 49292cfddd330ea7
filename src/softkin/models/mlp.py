"""Multi-layer perceptron: one network for all coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from softkin.core.samples import Array, Params, Samples
from softkin.models.estimators.polynomial_terms import bounded_trend
from softkin.models.spec import TRENDS, ModelSpec

if TYPE_CHECKING:
    from optuna.trial import BaseTrial


def build(params: Params, seed: int, threads: int) -> Any:
    """FusedNetwork(**params) with `width` neurons in each of `layers` hidden layers; `params` may set `random_state`.

    Several `networks` (default 1) differ in their seed alone, and their mean is predicted. All are fitted on the
    residuals of a `trend`.
    """
    from softkin.models.estimators.detrended import detrended

    return detrended(lambda rest: _networks(rest, seed), params)


def _networks(params: Params, seed: int) -> Any:
    from sklearn.ensemble import BaggingRegressor

    from softkin.models.estimators.fused_network import FusedNetwork

    rest = {key: value for key, value in params.items() if key not in ("layers", "width", "networks")}
    network = FusedNetwork(**{"random_state": seed, **rest}, hidden_layer_sizes=(params["width"],) * params["layers"])
    if params.get("networks", 1) == 1:
        return network
    return BaggingRegressor(network, params["networks"], bootstrap=False, random_state=seed)


def spread(regressor: Any, train: Samples, commands: Array) -> Array:
    """Predictive standard deviation by the last layer's Laplace approximation.

    Several networks are a mixture, of variance: the mean of their variances plus the variance of their means
    (Lakshminarayanan et al. 2017, section 2.4).
    """
    from softkin.models.estimators.detrended import spread_around

    return spread_around(_spread_of_networks, regressor, train, commands)


def _spread_of_networks(regressor: Any, train: Samples, commands: Array) -> Array:
    from softkin.models.estimators.last_layer_laplace import last_layer_laplace

    networks = getattr(regressor, "estimators_", [regressor])
    variances = [np.square(last_layer_laplace(network, train, commands)) for network in networks]
    means = [network.predict(commands).reshape(len(commands), -1) for network in networks]
    return np.asarray(np.sqrt(np.mean(variances, axis=0) + np.var(means, axis=0)))


def search_space(trial: BaseTrial) -> Params:
    """Small smooth networks by L-BFGS, one or three, or a larger one by Adam; all stop when they no longer improve."""
    solver = trial.suggest_categorical("solver", ["lbfgs", "adam"])
    params = {
        "trend": trial.suggest_categorical("trend", TRENDS),
        "solver": solver,
        "layers": trial.suggest_int("layers", 1, 2),
        "width": trial.suggest_int("width", 8, 64, log=True),
        "activation": trial.suggest_categorical("activation", ["tanh", "relu", "logistic"]),
        "alpha": trial.suggest_float("alpha", 1e-6, 1e-1, log=True),
        "max_iter": 600,
    }
    if solver == "adam":
        params["learning_rate_init"] = trial.suggest_float("learning_rate_init", 5e-4, 2e-2, log=True)
        params["n_iter_no_change"] = 30
    else:
        params["networks"] = trial.suggest_categorical("networks", [1, 3])
    return params


_START = {"solver": "lbfgs", "layers": 2, "activation": "tanh"}

SPEC = ModelSpec(
    name="mlp",
    title="Multi-layer perceptron",
    family="neural network",
    build=build,
    # The paper's network was stopped after a dozen passes; ABAQUS after 14 (its entry in config/datasets.yaml).
    paper_params={"layers": 1, "width": 100, "random_state": 1, "max_iter": 12},
    search_space=search_space,
    first_trials=(
        {"trend": "none", **_START, "width": 16, "alpha": 1e-2, "networks": 3},
        {"trend": "linear", **_START, "width": 16, "alpha": 1e-2, "networks": 3},
        {"trend": "none", **_START, "width": 32, "alpha": 1e-3, "networks": 1},
    ),
    bounded=bounded_trend,
    spread=spread,
    is_predictive=True,
)
