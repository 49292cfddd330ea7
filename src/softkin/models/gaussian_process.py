"""Gaussian process: one kernel, and so one Cholesky factor, for all coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from softkin.core.samples import Array, Params, Samples
from softkin.models.spec import TRENDS, ModelSpec

if TYPE_CHECKING:
    from optuna.trial import BaseTrial


def build(params: Params, seed: int, threads: int) -> Any:
    """Exact GP on all rows; kernel hyperparameters learnt on at most `learning_rows` of them."""
    from softkin.models.estimators.bounded_gaussian_process import BoundedGaussianProcess

    return BoundedGaussianProcess(**params, random_state=seed)


def spread(regressor: Any, train: Samples, commands: Array) -> Array:
    """Standard deviation of the posterior predictive distribution, noise included."""
    return np.asarray(regressor.predict_std(commands))


def search_space(trial: BaseTrial) -> Params:
    """Shape of the kernel and where its likelihood is started from; the rest is learnt by maximum likelihood."""
    return {
        "kernel": trial.suggest_categorical("kernel", ["rbf", "matern32", "matern52", "rational_quadratic"]),
        "trend": trial.suggest_categorical("trend", TRENDS),
        "initial_length_scale": trial.suggest_float("initial_length_scale", 0.3, 10.0, log=True),
        "initial_noise": trial.suggest_float("initial_noise", 1e-8, 1e-1, log=True),
        "learning_rows": 200,
        "max_iter": 40,
    }


_START = {"initial_length_scale": 1.0, "initial_noise": 1e-3}

SPEC = ModelSpec(
    name="gp",
    title="Gaussian process",
    family="kernel",
    build=build,
    # scikit-learn's optimiser holds n x n x n_coordinates doubles: 1200 rows take all of FINGER and ELASTICA.
    paper_params={"kernel": "none", "trend": "paper_linear", "learning_rows": 1200, "max_iter": 60},
    search_space=search_space,
    first_trials=(
        {"kernel": "rbf", "trend": "none", **_START},
        {"kernel": "rbf", "trend": "linear", **_START},
        {"kernel": "rational_quadratic", "trend": "linear", **_START},
    ),
    spread=spread,
    is_predictive=True,
)
