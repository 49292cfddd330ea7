from __future__ import annotations

import pytest

from softkin.core.fit_rows import bounds_of, rows_of_fit

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
