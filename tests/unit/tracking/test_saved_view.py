from __future__ import annotations

import base64
import json
import zlib
from typing import Any

from softkin.tracking.saved_view import COLUMNS, NAME, TAG, saved_view


def state() -> dict[str, Any]:
    packed = json.loads(saved_view())["state"]
    unpacked: dict[str, Any] = json.loads(zlib.decompress(base64.b64decode(packed.removeprefix("deflate;"))))
    return unpacked


def test_the_view_shows_the_models_best_on_test_first() -> None:
    assert state()["searchFilter"] == 'tags.kind = "model"'
    assert state()["orderByKey"] == "metrics.`test/euclidean_mean_mm`" == COLUMNS[0]
    assert state()["orderByAsc"] is True


def test_its_columns_are_errors_and_what_tells_runs_apart() -> None:
    columns = state()["selectedColumns"]
    assert columns == COLUMNS
    assert len(set(columns)) == len(columns)
    assert {"metrics.`extrapolation/rmse_mm`", "tags.`model`", "tags.`leak`"} <= set(columns)


def test_the_same_view_is_the_same_text_under_its_name() -> None:
    assert saved_view() == saved_view()
    assert json.loads(saved_view())["name"] == NAME
    assert TAG.startswith("mlflow.sharedViewState.")
