from __future__ import annotations

import pytest

from softkin.reporting.page.interval_rows import RUN, interval_rows
from tests.unit.reporting.page.frames import interval_metrics


def test_a_row_holds_mean_joint_and_guarantee() -> None:
    rows = interval_rows(interval_metrics())
    assert not rows.duplicated(RUN).any()
    assert len(rows) == len(interval_metrics()[RUN].drop_duplicates())
    by_run = rows.set_index(["subset", "interval_method", "confidence_level"]).sort_index()
    conformal = by_run.loc[("test", "cps", 0.9)].iloc[0]
    assert (conformal["coverage"], conformal["joint_coverage"]) == (0.9, 0.7)
    assert (conformal["guarantee"], conformal["as_guaranteed"]) == ("marginal", "1 of 2")
    region = by_run.loc[("test", "joint_box", 0.9)].iloc[0]
    assert (region["guarantee"], region["as_guaranteed"]) == ("joint", "yes")


@pytest.mark.parametrize("method", ["cps", "joint_box"])
def test_in_extrapolation_nothing_is_guaranteed(method: str) -> None:
    rows = interval_rows(interval_metrics())
    extrapolation = rows[(rows["subset"] == "extrapolation") & (rows["interval_method"] == method)]
    assert set(extrapolation["guarantee"]) == {"no guarantee"}
    assert set(extrapolation["as_guaranteed"]) == {"–"}


def test_a_region_off_its_band_breaks_its_guarantee() -> None:
    metrics = interval_metrics()
    metrics.loc[metrics["coordinate"] == "joint", "coverage"] = 0.9
    rows = interval_rows(metrics)
    regions = rows[(rows["interval_method"] == "joint_box") & (rows["subset"] == "test")]
    assert set(regions["as_guaranteed"]) == {"no"}
