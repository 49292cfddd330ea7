"""Random forest: one forest for all coordinates at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from softkin.core.samples import Array, Params, Samples
from softkin.models.estimators.polynomial_terms import bounded_trend
from softkin.models.spec import TRENDS, ModelSpec

if TYPE_CHECKING:
    from optuna.trial import BaseTrial


def build(params: Params, seed: int, threads: int) -> Any:
    """QuickForest(**params), on the residuals of a `trend`."""
    from softkin.models.estimators.detrended import detrended
    from softkin.models.estimators.quick_forest import QuickForest

    return detrended(lambda rest: QuickForest(**rest, random_state=seed, n_jobs=threads), params)


def spread(regressor: Any, train: Samples, commands: Array) -> Array:
    """Standard deviation over the trees."""
    from softkin.models.estimators.detrended import spread_around

    return spread_around(_spread_of_trees, regressor, train, commands)


def _spread_of_trees(regressor: Any, train: Samples, commands: Array) -> Array:
    trees = np.stack([tree.predict(commands) for tree in regressor.estimators_])
    return np.asarray(trees.std(axis=0).reshape(len(commands), -1))


def search_space(trial: BaseTrial) -> Params:
    """Deep trees; leaf size and the share of commands that a split chooses from matter most."""
    return {
        "trend": trial.suggest_categorical("trend", TRENDS),
        "n_estimators": trial.suggest_int("n_estimators", 50, 300, step=50),
        "max_depth": trial.suggest_int("max_depth", 6, 24),
        "min_samples_leaf": trial.suggest_int("min_samples_leaf", 1, 8),
        "max_features": trial.suggest_float("max_features", 0.3, 1.0),
        "bootstrap": trial.suggest_categorical("bootstrap", [True, False]),
    }


_START = {"n_estimators": 100, "max_depth": 24, "min_samples_leaf": 1, "max_features": 1.0, "bootstrap": True}

SPEC = ModelSpec(
    name="rf",
    title="Random forest",
    family="ensemble",
    build=build,
    paper_params={"n_estimators": 100, "max_depth": 2},
    search_space=search_space,
    first_trials=tuple({"trend": trend, **_START} for trend in TRENDS),
    bounded=bounded_trend,
    spread=spread,
    is_cheap=True,
)
