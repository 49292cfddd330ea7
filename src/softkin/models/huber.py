"""Robust polynomial: Huber's regression on polynomial features of the commands, coordinate by coordinate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from softkin.core.samples import Params
from softkin.models.estimators.polynomial_terms import bounded_degree
from softkin.models.spec import ModelSpec

if TYPE_CHECKING:
    from optuna.trial import BaseTrial

MAX_ITER = 1000


def build(params: Params, seed: int, threads: int) -> Any:
    """Polynomial of `degree` fitted with `epsilon` and `alpha` of HuberRegressor: beyond epsilon standard deviations a
    residual counts linearly, so that a gross error hardly changes the fit.
    """
    from sklearn.pipeline import make_pipeline

    from softkin.models.estimators.bounded_polynomial import BoundedPolynomial
    from softkin.models.estimators.per_target import PerTarget
    from softkin.models.estimators.quick_huber import QuickHuber

    features = {key: value for key, value in params.items() if key in ("degree", "interactions")}
    rest = {key: value for key, value in params.items() if key not in features}
    return make_pipeline(BoundedPolynomial(**features), PerTarget(QuickHuber(**rest, max_iter=MAX_ITER)))


def search_space(trial: BaseTrial) -> Params:
    """Degree 1 to 4, the residual beyond which a row counts linearly, and the penalty."""
    return {
        "degree": trial.suggest_int("degree", 1, 4),
        "epsilon": trial.suggest_float("epsilon", 1.05, 3.0),
        "alpha": trial.suggest_float("alpha", 1e-7, 1e-2, log=True),
    }


SPEC = ModelSpec(
    name="huber",
    title="Robust polynomial",
    family="linear",
    build=build,
    # Not in the paper: scikit-learn's defaults, on quadratic features.
    paper_params={"degree": 2, "epsilon": 1.35, "alpha": 1e-4},
    search_space=search_space,
    first_trials=tuple({"degree": degree, "epsilon": 1.35, "alpha": 1e-4} for degree in (2, 3, 4)),
    bounded=bounded_degree,
    is_cheap=True,
    is_robust=True,
)
