"""XGBoost's multi-quantile objective: all quantiles in one ensemble."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from softkin.core.samples import Params
from softkin.models.estimators.polynomial_terms import bounded_trend
from softkin.models.quantile.spec import QuantileSpec
from softkin.models.spec import TRENDS

if TYPE_CHECKING:
    from optuna.trial import BaseTrial


def build(params: Params, quantiles: Sequence[float], seed: int, threads: int) -> Any:
    """XGBRegressor(objective="reg:quantileerror", **params), on the residuals of a `trend`."""
    from softkin.models.estimators.detrended import detrended
    from softkin.models.estimators.quick_xgboost import QuickXGBoost

    fixed = {"objective": "reg:quantileerror", "quantile_alpha": list(quantiles)}
    return detrended(lambda rest: QuickXGBoost(**fixed, **rest, random_state=seed, n_jobs=threads), params)


def search_space(trial: BaseTrial) -> Params:
    """At most 300 trees, all quantiles in each."""
    return {
        "trend": trial.suggest_categorical("trend", TRENDS),
        "n_estimators": trial.suggest_int("n_estimators", 50, 300, step=50),
        "learning_rate": trial.suggest_float("learning_rate", 0.03, 0.3, log=True),
        "max_depth": trial.suggest_int("max_depth", 2, 6),
        "subsample": trial.suggest_float("subsample", 0.4, 1.0),
        "min_child_weight": trial.suggest_float("min_child_weight", 0.5, 20.0, log=True),
    }


_START = {"n_estimators": 300, "learning_rate": 0.05, "max_depth": 4, "subsample": 1.0, "min_child_weight": 1.0}

SPEC = QuantileSpec(
    name="xgb",
    title="XGBoost",
    build=build,
    paper_params={},
    search_space=search_space,
    first_trials=tuple({"trend": trend, **_START} for trend in TRENDS),
    bounded=bounded_trend,
)
