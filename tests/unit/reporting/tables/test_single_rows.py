from __future__ import annotations

import pandas as pd
import pytest

from softkin.reporting.tables.single_rows import Hanging, Number, hanging, of_runs

ROW = {"dataset": "arm", "subset": "test", "model": "gb", "preset": "paper", "interval_method": ""}


def left_out() -> pd.DataFrame:
    """Row 3 sets the RMSE of one run; of two scores of intervals, one hangs on it."""
    numbers = [
        ("gp", "", "rmse_mm", 2.0, {"row 3": 0.2, "row 7": 1.7}),
        ("gb", "", "rmse_mm", 2.0, {"row 3": 1.99, "row 7": 2.01}),
        ("gb", "scp_mapie", "winkler_mm", 10.0, {"row 3": 1.0, "row 7": 10.0}),
        ("gp", "cqr", "winkler_mm", 2.0, {"row 3": 2.0, "row 7": 2.0}),
        ("gp", "", "r2", 0.9, {"m1_x": 0.4}),
    ]
    return pd.DataFrame(
        ROW
        | {"left_out": row, "model": model, "interval_method": method, "metric": metric}
        | {"value": value, "without": to}
        for model, method, metric, value, without in numbers
        for row, to in without.items()
    )


def test_a_number_that_changes_by_much_names_the_row_that_changes_it_most() -> None:
    found = hanging(left_out())
    assert found[Number("arm", "test", "gp", "paper", "rmse_mm")] == Hanging("row 3", 2.0, 0.2)
    assert Number("arm", "test", "gb", "paper", "rmse_mm") not in found
    assert found[Number("arm", "test", "gp", "paper", "r2")].text == "without m1_x it is 0.400"
    assert Number("arm", "test", "gb", "paper", "rmse_mm") in hanging(left_out(), share=0.004)


def test_a_ratio_is_of_the_same_rows() -> None:
    """The interval hangs on no row; its ratio to the paper's recipe does: 0.2, and 2 without row 3."""
    found = hanging(left_out())
    ratio = found[Number("arm", "test", "gp", "paper", "winkler_ratio_to_paper", "cqr")]
    assert ratio.left_out == "row 3"
    assert [ratio.value, ratio.without] == pytest.approx([0.2, 2.0])
    assert Number("arm", "test", "gp", "paper", "winkler_mm", "cqr") not in found


def test_of_the_deployed_runs_one_metric_is_told() -> None:
    runs = pd.DataFrame([{"dataset": "arm", "model": "gp", "preset": "paper"}])
    assert of_runs(hanging(left_out()), runs, "rmse_mm") == {("arm", "test"): Hanging("row 3", 2.0, 0.2)}
    assert of_runs(hanging(left_out()), runs.assign(model="gb"), "rmse_mm") == {}


def test_nothing_left_out_is_nothing_to_hang_on() -> None:
    assert hanging(left_out().iloc[:0]) == {}
