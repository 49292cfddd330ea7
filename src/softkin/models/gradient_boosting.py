"""Gradient boosting (scikit-learn): one ensemble per coordinate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from softkin.core.samples import Params
from softkin.models.estimators.polynomial_terms import bounded_trend
from softkin.models.spec import TRENDS, ModelSpec

if TYPE_CHECKING:
    from optuna.trial import BaseTrial


def build(params: Params, seed: int, threads: int) -> Any:
    """One ensemble of `boosted_trees` per coordinate, on the residuals of a `trend`."""
    from softkin.models.estimators.boosted_trees import boosted_trees
    from softkin.models.estimators.detrended import detrended
    from softkin.models.estimators.per_target import PerTarget

    return detrended(lambda rest: PerTarget(boosted_trees(rest, seed)), params)


def search_space(trial: BaseTrial) -> Params:
    """Histograms of 255 bins, the most there are: fewer cost a noiseless robot a third of its accuracy."""
    return {
        "tree_method": "hist",
        "trend": trial.suggest_categorical("trend", TRENDS),
        "max_iter": trial.suggest_int("max_iter", 100, 250, step=50),
        "learning_rate": trial.suggest_float("learning_rate", 0.03, 0.3, log=True),
        "max_depth": trial.suggest_int("max_depth", 2, 5),
        "max_features": trial.suggest_float("max_features", 0.4, 1.0),
        "min_samples_leaf": trial.suggest_int("min_samples_leaf", 1, 20, log=True),
    }


_START = {"max_features": 1.0, "min_samples_leaf": 1}
_FIRST = ("linear", "quadratic", "none")

SPEC = ModelSpec(
    name="gb",
    title="Gradient boosting",
    family="ensemble",
    build=build,
    # No histograms: scikit-learn's own settings of its GradientBoostingRegressor.
    paper_params={},
    search_space=search_space,
    first_trials=tuple(
        {"trend": trend, "max_iter": 100, "learning_rate": 0.1, "max_depth": 3, **_START} for trend in _FIRST
    ),
    bounded=bounded_trend,
    is_cheap=True,
)
