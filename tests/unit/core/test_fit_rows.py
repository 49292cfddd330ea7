from __future__ import annotations

import pytest
import yaml

from softkin.core.fit_rows import bounds_of, rows_of_fit
from softkin.core.rows import MANY_ROWS
from softkin.core.samples import SUBSETS, TRAIN
from tests.conftest import HOUSE

BOUNDS = {"gp": 4000, "gb": 10000, "rf": 300, "quantile_xgb": 500, "quantile_lr": 7}


@pytest.mark.parametrize(
    ("model", "quantile_model", "most"),
    [("gp", None, 4000), ("xgb", None, None), (None, "gb", 10000), (None, "xgb", 500), (None, "other", None)],
)
def test_a_quantile_regressor_has_its_own_bound_or_that_of_the_model_of_its_name(
    model: str | None, quantile_model: str | None, most: int | None
) -> None:
    assert rows_of_fit(BOUNDS, model, quantile_model) == most


def test_bounds_of_what_is_not_fitted_are_left_out() -> None:
    assert bounds_of(BOUNDS, ["gp", "xgb"], ["xgb", "gb"]) == {"gp": 4000, "gb": 10000, "quantile_xgb": 500}


def test_bounds_of_the_default_configuration_lie_above_the_sizes_of_published_robots() -> None:
    """Their numbers follow from all their rows, to the bit."""
    config, entries = (
        yaml.safe_load((HOUSE / "config" / name).read_text(encoding="utf-8"))
        for name in ("config.yaml", "datasets.yaml")
    )
    sizes = [entry["rows"] for entry in entries["sources"].values() if "rows" in entry]
    assert len(sizes) >= 4
    largest = {subset: max(rows[subset] for rows in sizes) for subset in SUBSETS}
    assert min(*config["max_fit_rows"].values(), config["shells"]["max_rows"], MANY_ROWS) > largest.pop(TRAIN)
    assert config["max_scored_rows"] > max(largest.values())
