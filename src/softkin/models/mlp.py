"""Multi-layer perceptron: one network for all coordinates."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from softkin.interface import Array, ModelSpec, Params, Samples

if TYPE_CHECKING:
    from optuna.trial import BaseTrial

ALSO_DECIDED_BY = (Path(__file__).parent.parent / "estimators" / "last_layer_laplace.py",)


def build(params: Params, seed: int, threads: int) -> Any:
    """MLPRegressor(**params) with `width` neurons in each of `layers` hidden layers; `random_state` may be given."""
    from sklearn.neural_network import MLPRegressor

    rest = {key: value for key, value in params.items() if key not in ("layers", "width")}
    return MLPRegressor(**{"random_state": seed, **rest}, hidden_layer_sizes=(params["width"],) * params["layers"])


def spread(regressor: Any, train: Samples, commands: Array) -> Array:
    """Standard deviation of the last layer's Laplace approximation: the network as a Bayesian one."""
    from softkin.estimators.last_layer_laplace import last_layer_laplace

    return last_layer_laplace(regressor, train, commands)


def search_space(trial: BaseTrial) -> Params:
    """Small smooth networks by L-BFGS, or larger ones by Adam; both run until they stop improving."""
    solver = trial.suggest_categorical("solver", ["lbfgs", "adam"])
    params = {
        "solver": solver,
        "layers": trial.suggest_int("layers", 1, 2),
        "width": trial.suggest_int("width", 8, 64, log=True),
        "activation": trial.suggest_categorical("activation", ["tanh", "relu", "logistic"]),
        "alpha": trial.suggest_float("alpha", 1e-6, 1e-1, log=True),
        "max_iter": 2000,
    }
    if solver == "adam":
        params["learning_rate_init"] = trial.suggest_float("learning_rate_init", 5e-4, 2e-2, log=True)
        params["n_iter_no_change"] = 30
    return params


SPEC = ModelSpec(
    name="mlp",
    title="Multi-layer perceptron",
    family="neural network",
    build=build,
    # The paper's network was stopped after a dozen passes; ABAQUS after 14 (its entry in config/datasets.yaml).
    paper_params={"layers": 1, "width": 100, "random_state": 1, "max_iter": 12},
    search_space=search_space,
    first_trials=(
        {"solver": "lbfgs", "layers": 2, "width": 16, "activation": "tanh", "alpha": 1e-2},
        {"solver": "lbfgs", "layers": 2, "width": 32, "activation": "tanh", "alpha": 1e-3},
    ),
    spread=spread,
    is_predictive=True,
)
