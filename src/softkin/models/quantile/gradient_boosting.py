"""Gradient boosting of the pinball loss (scikit-learn), one ensemble per quantile: the paper's QR."""

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
    """One ensemble of `boosted_trees` per quantile, on the residuals of a `trend`."""
    from softkin.models.estimators.boosted_quantiles import BoostedQuantiles
    from softkin.models.estimators.detrended import detrended

    return detrended(lambda rest: BoostedQuantiles(tuple(quantiles), rest, random_state=seed), params)


def search_space(trial: BaseTrial) -> Params:
    """At most 150 trees, by histograms of 255 bins: with two ensembles per coordinate and level no fit costs more."""
    return {
        "tree_method": "hist",
        "trend": trial.suggest_categorical("trend", TRENDS),
        "max_iter": trial.suggest_int("max_iter", 50, 150, step=25),
        "learning_rate": trial.suggest_float("learning_rate", 0.03, 0.3, log=True),
        "max_depth": trial.suggest_int("max_depth", 2, 5),
        "max_features": trial.suggest_float("max_features", 0.4, 1.0),
        "min_samples_leaf": trial.suggest_int("min_samples_leaf", 1, 20, log=True),
    }


_START = {"max_iter": 100, "learning_rate": 0.1, "max_depth": 3, "max_features": 1.0, "min_samples_leaf": 3}

SPEC = QuantileSpec(
    name="gb",
    title="Gradient boosting",
    build=build,
    paper_params={},
    search_space=search_space,
    first_trials=tuple({"trend": trend, **_START} for trend in TRENDS),
    bounded=bounded_trend,
)
