"""Save a view of the runs for the *Views* menu of MLflow's UI: its default columns show no metrics."""

from __future__ import annotations

import base64
import json
import zlib

from softkin.core.samples import EXTRAPOLATION, TEST

NAME = "Models by error"
#: MLflow's UI keeps a saved view in a tag of the experiment; its link ends with viewStateShareKey=models_by_error.
TAG = "mlflow.sharedViewState.models_by_error"
COLUMNS = [
    *(f"metrics.`{subset}/{name}`" for subset in (TEST, EXTRAPOLATION) for name in ("euclidean_mean_mm", "rmse_mm")),
    "metrics.`cv_mae_mm`",
    *(f"tags.`{name}`" for name in ("model", "preset", "leak")),
]


def saved_view() -> str:
    """The value of the tag `TAG`: a view of the models alone, best on test first."""
    state = {
        "searchFilter": 'tags.kind = "model"',
        "orderByKey": COLUMNS[0],
        "orderByAsc": True,
        "startTime": "ALL",
        "lifecycleFilter": "Active",
        "datasetsFilter": [],
        "modelVersionFilter": "All Runs",
        "selectedColumns": COLUMNS,
    }
    packed = base64.b64encode(zlib.compress(json.dumps(state).encode())).decode()
    return json.dumps({"name": NAME, "createdAt": 0, "updatedAt": 0, "state": f"deflate;{packed}"})
