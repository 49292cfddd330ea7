"""The pool: one file a model, one line here. Importing this package imports no learning library."""

from __future__ import annotations

import sys
from pathlib import Path

from softkin.interface import ModelSpec
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


def source_files(model: str) -> list[Path]:
    """The files that decide what `model` is: its own, and those of our own estimators that it names."""
    module = sys.modules[MODELS[model].build.__module__]
    return [Path(str(module.__file__)), *getattr(module, "ALSO_DECIDED_BY", ())]
