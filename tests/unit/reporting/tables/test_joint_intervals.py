from __future__ import annotations

from typing import Any

import pandas as pd

from softkin.reporting.tables.joint_intervals import joint_scores

KEY = {"dataset": "arm", "model": "gp", "preset": "tuned"}
BEST: dict[str, Any] = {**KEY, "interval_method": "scp_spread", "outside": "auto", "confidence_level": 0.9}
BEST["extrapolation_assessable"] = True
DEPLOYED = pd.DataFrame([BEST]).set_index("dataset", drop=False)


def metrics() -> pd.DataFrame:
    """Joint rows of three methods at two levels; those at 90 % around the deployed run count."""
    rows = []
    for method, subset, coverage in (
        *(("joint_intervals", "test", 0.91), ("joint_intervals", "extrapolation", 0.83)),
        *(("scp_spread", "test", 0.62), ("scp_spread", "extrapolation", 0.1)),
        *(("auto", "test", 0.2), ("auto", "extrapolation", 0.7)),
    ):
        for model, level, factor in (("gp", 0.9, 1.0), ("gp", 0.8, 0.5), ("lr", 0.9, 0.25)):
            row: dict[str, Any] = {
                **KEY,
                "model": model,
                "coordinate": "joint",
                "interval_method": method,
                "subset": subset,
            }
            row |= {"confidence_level": level, "coverage": coverage * factor, "size_mm": 3.0, "shape": "ellipsoids"}
            rows.append(row)
    return pd.DataFrame(rows)


def test_the_deployed_joint_interval_stands_beside_the_deployed_intervals() -> None:
    row = joint_scores(metrics(), DEPLOYED).loc["arm"]
    assert row.to_dict() == {
        **{"shape": "ellipsoids", "size_mm": 3.0, "test": 0.91, "extrapolation": 0.83},
        **{"single_test": 0.62, "single_extrapolation": 0.7, "assessable": True},
    }


def test_a_run_without_joint_intervals_has_no_row() -> None:
    without = metrics()[metrics()["interval_method"] != "joint_intervals"]
    assert joint_scores(without, DEPLOYED).empty
