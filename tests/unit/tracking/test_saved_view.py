from __future__ import annotations

import base64
import json
import zlib
from typing import Any

import pytest

from softkin.tracking.saved_view import ERRORS, NAME, campaigns_view, champions_view, saved_view

VIEWS = [saved_view(), champions_view(), campaigns_view(["metrics.`finger/test/rmse_mm`"])]


def state(view: str) -> dict[str, Any]:
    packed = json.loads(view)["state"]
    unpacked: dict[str, Any] = json.loads(zlib.decompress(base64.b64decode(packed.removeprefix("deflate;"))))
    return unpacked


def test_the_view_shows_the_current_models_best_on_test_first() -> None:
    assert state(saved_view())["searchFilter"] == 'tags.kind = "model" and tags.current = "true"'
    assert state(saved_view())["orderByKey"] == "metrics.`test/euclidean_mean_mm`" == ERRORS[0]
    assert state(saved_view())["orderByAsc"] is True
    assert json.loads(saved_view())["name"] == NAME


def test_calibrated_models_stand_side_by_side_with_errors_and_intervals() -> None:
    columns = state(champions_view())["selectedColumns"]
    assert {*ERRORS, "tags.`dataset`", "metrics.`test/coverage_90`"} <= set(columns)
    assert 'current = "true"' in state(champions_view())["searchFilter"]


def test_nights_stand_the_last_one_first() -> None:
    assert state(VIEWS[2])["orderByAsc"] is False
    assert state(VIEWS[2])["selectedColumns"] == ["metrics.`finger/test/rmse_mm`"]


@pytest.mark.parametrize("view", VIEWS)
def test_no_column_stands_twice(view: str) -> None:
    columns = state(view)["selectedColumns"]
    assert len(set(columns)) == len(columns)
