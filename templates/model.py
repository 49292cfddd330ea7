"""Nearest neighbours: the mean position of the rows whose commands are nearest."""
# To add a point model: copy this file to src/softkin/models/<name>.py, fill in what the comments name, and add to
# src/softkin/models/__init__.py the import of the module and the line
#     "my_model": my_model.SPEC,
# Then name it in `models` of config/config.yaml, and run: pytest tests/contract/test_models.py -k my_model

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from softkin.core.samples import Params
from softkin.models.spec import ModelSpec

if TYPE_CHECKING:
    from optuna.trial import BaseTrial


def build(params: Params, seed: int, threads: int) -> Any:
    """KNeighborsRegressor(**params)."""
    # Any scikit-learn regressor of several targets; one of a single target goes into a PerTarget, of
    # softkin.models.estimators.per_target. Commands and positions come standardised. Import the library here: Snakemake
    # imports this module each time it starts. Pass `seed` on to whatever draws at random, and use at most `threads`
    # threads.
    from sklearn.neighbors import KNeighborsRegressor

    return KNeighborsRegressor(**params, n_jobs=threads)


def search_space(trial: BaseTrial) -> Params:
    """Number of neighbours, and whether near ones count more."""
    # All that `build` needs; values must survive a record in JSON.
    return {
        "n_neighbors": trial.suggest_int("n_neighbors", 1, 20, log=True),
        "weights": trial.suggest_categorical("weights", ["uniform", "distance"]),
    }


SPEC = ModelSpec(
    # The key in the registry, and what tables and figures call it.
    name="my_model",
    title="My model",
    # linear, ensemble, kernel or neural network.
    family="kernel",
    build=build,
    # The settings of the preset `paper`: the library's own for a model that the paper does not have.
    paper_params={},
    search_space=search_space,
    # Good guesses, tried before any other: every drawn parameter of each, within its bounds.
    first_trials=(
        {"n_neighbors": 5, "weights": "distance"},
        {"n_neighbors": 2, "weights": "distance"},
    ),
    # Optional: `spread` for a model that estimates its own uncertainty, `is_predictive` if that is a standard deviation
    # of a predictive distribution, `is_robust` if a few gross errors cannot move it. `is_cheap` admits it to CV+ and
    # jackknife+-after-bootstrap, which fit it dozens of times.
    is_cheap=True,
)
