"""Support vector regression: one regressor per coordinate, RBF or polynomial kernel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from softkin.core.samples import Params
from softkin.models.estimators.polynomial_terms import bounded_trend
from softkin.models.spec import TRENDS, ModelSpec

if TYPE_CHECKING:
    from optuna.trial import BaseTrial

#: Bounds libsvm's iterations per coordinate. Without it C=100, epsilon=0.001 runs for minutes on 3160 rows; with it
#: the solver stops close to the optimum.
MAX_ITER = 20_000
CACHE_MB = 400


def build(params: Params, seed: int, threads: int) -> Any:
    """One SVR(**params) per coordinate, on the residuals of a `trend`; `max_iter` (default none) bounds the solver."""
    from sklearn.svm import SVR

    from softkin.models.estimators.detrended import detrended
    from softkin.models.estimators.support_vectors import SupportVectors

    return detrended(lambda rest: SupportVectors(SVR(**rest, cache_size=CACHE_MB)), params)


def search_space(trial: BaseTrial) -> Params:
    """Kernel and width, penalty and tube; a polynomial of degree 2 or 3 is the shape of a bending arm."""
    kernel = trial.suggest_categorical("kernel", ["rbf", "poly"])
    params = {
        "trend": trial.suggest_categorical("trend", TRENDS),
        "kernel": kernel,
        "C": trial.suggest_float("C", 0.1, 100.0, log=True),
        "epsilon": trial.suggest_float("epsilon", 0.002, 0.3, log=True),
        "gamma": trial.suggest_float("gamma", 0.02, 2.0, log=True),
        "max_iter": MAX_ITER,
    }
    if kernel == "poly":
        params |= {"degree": trial.suggest_int("degree", 2, 3), "coef0": 1.0}
    return params


SPEC = ModelSpec(
    name="svr",
    title="Support vector regression",
    family="kernel",
    build=build,
    paper_params={},
    search_space=search_space,
    first_trials=(
        {"trend": "none", "kernel": "rbf", "C": 10.0, "epsilon": 0.01, "gamma": 0.3},
        {"trend": "linear", "kernel": "rbf", "C": 10.0, "epsilon": 0.01, "gamma": 0.3},
        {"trend": "none", "kernel": "poly", "C": 1.0, "epsilon": 0.01, "gamma": 0.3, "degree": 2},
    ),
    bounded=bounded_trend,
    is_cheap=True,
)
