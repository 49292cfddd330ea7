"""Ridge regression on quadratic or cubic features of the commands, the shape of a bending arm."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from softkin.core.samples import Params
from softkin.models.estimators.polynomial_terms import bounded_degree
from softkin.models.spec import ModelSpec

if TYPE_CHECKING:
    from optuna.trial import BaseTrial


def build(params: Params, seed: int, threads: int) -> Any:
    """Polynomial of `degree` with a penalty of `alpha` on its standardised terms."""
    from sklearn.linear_model import Ridge
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    from softkin.models.estimators.bounded_polynomial import BoundedPolynomial

    rest = dict(params)
    alpha = rest.pop("alpha")
    return make_pipeline(BoundedPolynomial(**rest), StandardScaler(), Ridge(alpha=alpha))


def search_space(trial: BaseTrial) -> Params:
    """Degree 2 or 3, and the penalty."""
    return {
        "degree": trial.suggest_int("degree", 2, 3),
        "alpha": trial.suggest_float("alpha", 1e-8, 1e2, log=True),
    }


SPEC = ModelSpec(
    name="ridge",
    title="Polynomial ridge",
    family="linear",
    build=build,
    # Not in the paper: scikit-learn's default, on quadratic features.
    paper_params={"degree": 2, "alpha": 1.0},
    search_space=search_space,
    first_trials=tuple({"degree": degree, "alpha": 1e-3} for degree in (2, 3)),
    bounded=bounded_degree,
    is_cheap=True,
)
