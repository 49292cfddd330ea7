from __future__ import annotations

import pytest

from softkin.reporting.page.scores import interval_rows
from tests.unit.reporting.page.conftest import interval_metrics


def test_a_row_holds_mean_joint_and_promise() -> None:
    rows = interval_rows(interval_metrics())
    keys = ["dataset", "subset", "model", "preset", "interval_method", "confidence_level"]
    assert not rows.duplicated(keys).any()
    assert len(rows) == len(interval_metrics()[keys].drop_duplicates())
    by_run = rows.set_index(["subset", "interval_method", "confidence_level"]).sort_index()
    conformal = by_run.loc[("test", "cps", 0.9)].iloc[0]
    assert (conformal["coverage"], conformal["joint_coverage"]) == (0.9, 0.7)
    assert (conformal["guarantee"], conformal["as_promised"]) == ("marginal", "1 of 2")
    region = by_run.loc[("test", "joint_box", 0.9)].iloc[0]
    assert (region["guarantee"], region["as_promised"]) == ("joint", "yes")


@pytest.mark.parametrize("method", ["cps", "joint_box"])
def test_outside_nothing_is_promised(method: str) -> None:
    rows = interval_rows(interval_metrics())
    outside = rows[(rows["subset"] == "extrapolation") & (rows["interval_method"] == method)]
    assert set(outside["guarantee"]) == {"no guarantee"}
    assert set(outside["as_promised"]) == {"–"}


def test_a_region_off_its_band_breaks_its_promise() -> None:
    metrics = interval_metrics()
    metrics.loc[metrics["coordinate"] == "joint", "coverage"] = 0.9
    rows = interval_rows(metrics)
    regions = rows[(rows["interval_method"] == "joint_box") & (rows["subset"] == "test")]
    assert set(regions["as_promised"]) == {"no"}
