"""Gradient boosting (scikit-learn): one ensemble per coordinate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from softkin.core.samples import Params
from softkin.models.estimators.polynomial_terms import bounded_trend
from softkin.models.spec import TRENDS, ModelSpec

if TYPE_CHECKING:
    from optuna.trial import BaseTrial


def build(params: Params, seed: int, threads: int) -> Any:
    """One GradientBoostingRegressor(**params) per coordinate, on the residuals of a `trend`."""
    from sklearn.ensemble import GradientBoostingRegressor

    from softkin.models.estimators.detrended import detrended
    from softkin.models.estimators.per_target import PerTarget

    return detrended(lambda rest: PerTarget(GradientBoostingRegressor(**rest, random_state=seed)), params)


def search_space(trial: BaseTrial) -> Params:
    """At most 250 trees of depth 6: with 21 coordinates (ABAQUS) no model costs more to fit."""
    return {
        "trend": trial.suggest_categorical("trend", TRENDS),
        "n_estimators": trial.suggest_int("n_estimators", 100, 250, step=50),
        "learning_rate": trial.suggest_float("learning_rate", 0.03, 0.3, log=True),
        "max_depth": trial.suggest_int("max_depth", 2, 6),
        "subsample": trial.suggest_float("subsample", 0.4, 1.0),
        "min_samples_leaf": trial.suggest_int("min_samples_leaf", 1, 20, log=True),
    }


_WHOLE = {"subsample": 1.0, "min_samples_leaf": 1}
_HALF = {"subsample": 0.5, "min_samples_leaf": 1}

SPEC = ModelSpec(
    name="gb",
    title="Gradient boosting",
    family="ensemble",
    build=build,
    paper_params={},
    search_space=search_space,
    first_trials=(
        {"trend": "linear", "n_estimators": 100, "learning_rate": 0.1, "max_depth": 3, **_WHOLE},
        {"trend": "quadratic", "n_estimators": 100, "learning_rate": 0.1, "max_depth": 3, **_WHOLE},
        {"trend": "none", "n_estimators": 250, "learning_rate": 0.05, "max_depth": 5, **_HALF},
    ),
    bounded=bounded_trend,
    is_cheap=True,
)
