"""Registry of point models: one file a model, one line here. Importing it imports no machine-learning library."""

from __future__ import annotations

from softkin.models import (
    gaussian_process,
    gradient_boosting,
    huber,
    lasso,
    linear,
    mlp,
    random_forest,
    ridge,
    svr,
    xgboost,
)
from softkin.models.spec import ModelSpec

#: In the order of the paper's tables, then ours.
MODELS: dict[str, ModelSpec] = {
    "lr": linear.SPEC,
    "lasso": lasso.SPEC,
    "rf": random_forest.SPEC,
    "gb": gradient_boosting.SPEC,
    "xgb": xgboost.SPEC,
    "svr": svr.SPEC,
    "gp": gaussian_process.SPEC,
    "mlp": mlp.SPEC,
    "ridge": ridge.SPEC,
    "huber": huber.SPEC,
}
