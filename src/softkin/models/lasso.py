"""LASSO: least squares with an L1 penalty on the commands, or on polynomial features of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from softkin.core.samples import Params
from softkin.models.estimators.polynomial_terms import bounded_degree
from softkin.models.spec import ModelSpec

if TYPE_CHECKING:
    from optuna.trial import BaseTrial

#: Bounds the coordinate descent of one coordinate; small penalties on high degrees stop here, near the optimum.
MAX_ITER = 5000


def build(params: Params, seed: int, threads: int) -> Any:
    """Lasso(alpha) on polynomial features of `degree` (default 1), standardised so that one penalty suits all."""
    from sklearn.linear_model import Lasso
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    from softkin.models.estimators.bounded_polynomial import BoundedPolynomial

    rest = dict(params)
    regressor = Lasso(alpha=rest.pop("alpha"), max_iter=MAX_ITER, precompute=True)
    if rest.get("degree", 1) == 1:
        return regressor
    return make_pipeline(BoundedPolynomial(**rest), StandardScaler(), regressor)


def search_space(trial: BaseTrial) -> Params:
    """Degree 1 to 6 and a penalty over six decades."""
    return {
        "degree": trial.suggest_int("degree", 1, 6),
        "alpha": trial.suggest_float("alpha", 1e-6, 1.0, log=True),
    }


SPEC = ModelSpec(
    name="lasso",
    title="LASSO",
    family="linear",
    build=build,
    paper_params={"alpha": 0.1},
    search_space=search_space,
    first_trials=({"degree": 1, "alpha": 0.1}, {"degree": 2, "alpha": 1e-3}, {"degree": 3, "alpha": 1e-4}),
    bounded=bounded_degree,
    is_cheap=True,
)
