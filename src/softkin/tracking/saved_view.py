"""Save views of runs for the *Views* menu of MLflow's UI: its default columns show no metrics, its rows all history."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Sequence

from softkin.core.samples import EXTRAPOLATION, TEST

NAME = "Models by error"
#: MLflow's UI keeps a saved view in a tag of the experiment; its link ends with viewStateShareKey=<key>.
KEY = "models_by_error"
TAG = f"mlflow.sharedViewState.{KEY}"
CHAMPIONS_KEY = "champions"
CHAMPIONS_TAG = f"mlflow.sharedViewState.{CHAMPIONS_KEY}"
CAMPAIGNS_KEY = "nights"
CAMPAIGNS_TAG = f"mlflow.sharedViewState.{CAMPAIGNS_KEY}"
ERRORS = [f"metrics.`{subset}/{name}`" for subset in (TEST, EXTRAPOLATION) for name in ("euclidean_mean_mm", "rmse_mm")]


def saved_view() -> str:
    """The value of the tag `TAG`: a view of the current models alone, best on test first."""
    columns = [*ERRORS, "metrics.`cv_mae_mm`", *(f"tags.`{name}`" for name in ("model", "preset", "leak"))]
    return _view(NAME, 'tags.kind = "model" and tags.current = "true"', columns, columns[0])


def champions_view() -> str:
    """The value of the tag `CHAMPIONS_TAG`: the current calibrated model of each dataset, with errors and intervals."""
    intervals = [
        f"metrics.`{subset}/{name}_90`" for subset in (TEST, EXTRAPOLATION) for name in ("coverage", "mean_width_mm")
    ]
    columns = [*(f"tags.`{name}`" for name in ("dataset", "model", "preset", "interval_method")), *ERRORS, *intervals]
    return _view("Calibrated models", 'tags.kind = "champion" and tags.current = "true"', columns, columns[0])


def campaigns_view(columns: Sequence[str]) -> str:
    """The value of the tag `CAMPAIGNS_TAG`: all campaigns, the last first, with these columns."""
    return _view("Nights", 'tags.kind = "night"', columns, "attributes.`Created`", ascending=False)


def _view(name: str, query: str, columns: Sequence[str], order: str, *, ascending: bool = True) -> str:
    state = {
        "searchFilter": query,
        "orderByKey": order,
        "orderByAsc": ascending,
        "startTime": "ALL",
        "lifecycleFilter": "Active",
        "datasetsFilter": [],
        "modelVersionFilter": "All Runs",
        "selectedColumns": list(columns),
    }
    packed = base64.b64encode(zlib.compress(json.dumps(state).encode())).decode()
    return json.dumps({"name": name, "createdAt": 0, "updatedAt": 0, "state": f"deflate;{packed}"})
