"""Random forest: one forest for all coordinates at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from softkin.interface import Array, ModelSpec, Params, Samples

if TYPE_CHECKING:
    from optuna.trial import BaseTrial


def build(params: Params, seed: int, threads: int) -> Any:
    """RandomForestRegressor(**params)."""
    from sklearn.ensemble import RandomForestRegressor

    return RandomForestRegressor(**params, random_state=seed, n_jobs=threads)


def spread(regressor: Any, train: Samples, commands: Array) -> Array:
    """Standard deviation over the trees."""
    trees = np.stack([tree.predict(commands) for tree in regressor.estimators_])
    return np.asarray(trees.std(axis=0).reshape(len(commands), -1))


def search_space(trial: BaseTrial) -> Params:
    """Deep trees; what matters is the leaf size and how many commands a split may choose from."""
    return {
        "n_estimators": trial.suggest_int("n_estimators", 50, 300, step=50),
        "max_depth": trial.suggest_int("max_depth", 6, 24),
        "min_samples_leaf": trial.suggest_int("min_samples_leaf", 1, 8),
        "max_features": trial.suggest_float("max_features", 0.3, 1.0),
        "bootstrap": trial.suggest_categorical("bootstrap", [True, False]),
    }


SPEC = ModelSpec(
    name="rf",
    title="Random forest",
    family="ensemble",
    build=build,
    paper_params={"n_estimators": 100, "max_depth": 2},
    search_space=search_space,
    first_trials=(
        {"n_estimators": 100, "max_depth": 24, "min_samples_leaf": 1, "max_features": 1.0, "bootstrap": True},
    ),
    spread=spread,
    is_cheap=True,
)
