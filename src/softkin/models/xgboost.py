"""XGBoost: histogram boosting, one tree per coordinate and round."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from softkin.core.samples import Params
from softkin.models.estimators.polynomial_terms import bounded_trend
from softkin.models.spec import TRENDS, ModelSpec

if TYPE_CHECKING:
    from optuna.trial import BaseTrial


def build(params: Params, seed: int, threads: int) -> Any:
    """QuickXGBoost(**params), on the residuals of a `trend`."""
    from softkin.models.estimators.detrended import detrended
    from softkin.models.estimators.quick_xgboost import QuickXGBoost

    return detrended(lambda rest: QuickXGBoost(**rest, random_state=seed, n_jobs=threads), params)


def search_space(trial: BaseTrial) -> Params:
    """Up to 400 rounds; depth, shrinkage and the three usual regularisers."""
    return {
        "trend": trial.suggest_categorical("trend", TRENDS),
        "n_estimators": trial.suggest_int("n_estimators", 100, 400, step=50),
        "learning_rate": trial.suggest_float("learning_rate", 0.03, 0.3, log=True),
        "max_depth": trial.suggest_int("max_depth", 2, 8),
        "subsample": trial.suggest_float("subsample", 0.4, 1.0),
        "min_child_weight": trial.suggest_float("min_child_weight", 0.5, 20.0, log=True),
        "reg_lambda": trial.suggest_float("reg_lambda", 1e-3, 10.0, log=True),
    }


#: XGBoost's own settings.
_START = {
    "n_estimators": 100,
    "learning_rate": 0.3,
    "max_depth": 6,
    "subsample": 1.0,
    "min_child_weight": 1.0,
    "reg_lambda": 1.0,
}

SPEC = ModelSpec(
    name="xgb",
    title="XGBoost",
    family="ensemble",
    build=build,
    paper_params={},
    search_space=search_space,
    first_trials=tuple({"trend": trend, **_START} for trend in TRENDS),
    bounded=bounded_trend,
    is_cheap=True,
)
