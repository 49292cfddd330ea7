from __future__ import annotations

import pytest

from softkin.reporting.tables.verdicts import unit, verdict


@pytest.mark.parametrize(
    ("printed", "one"), [("2.89", 0.01), ("14", 1.0), ("5.57e-3", 1e-5), ("-0.048", 0.001), ("0.0005", 1e-4)]
)
def test_one_unit_of_the_last_digit(printed: str, one: float) -> None:
    assert unit(printed) == pytest.approx(one)


@pytest.mark.parametrize(
    ("printed", "ours", "metric", "expected"),
    [
        ("2.89", 2.8912, "rmse_mm", "reproduced"),
        ("2.89", 2.8999, "rmse_mm", "reproduced"),  # truncated in print
        ("2.89", 2.88, "rmse_mm", "reproduced"),
        ("2.89", 2.9012, "rmse_mm", "worse"),
        ("2.89", 2.87, "rmse_mm", "better"),
        ("-0.048", -0.03, "r2", "better"),
        ("-0.048", -0.06, "r2", "worse"),
        ("5.57e-3", 0.0064, "mape_percent", "worse"),
    ],
)
def test_verdicts(printed: str, ours: float, metric: str, expected: str) -> None:
    assert verdict(printed, ours, metric) == expected
