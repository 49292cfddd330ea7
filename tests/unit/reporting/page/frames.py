"""Made-up tables of two robots: `arm`, whose test rows leak, and `finger`, whose deployed interval is not the chosen
one.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.runs import PAPER, TUNED
from softkin.core.samples import SUBSETS
from softkin.reporting.page.marks import Marks
from softkin.reporting.titles import Titles

ROBOTS, LEVELS = ("arm", "finger"), (0.8, 0.9)
PRESETS = (PAPER, TUNED)
MODELS = {"lr": "Linear regression", "gb": "Gradient boosting", "gp": "Gaussian process", "mlp": "Perceptron"}
METHODS = {"cqr": "CQR", "scp_mapie": "SCP (MAPIE)", "cps": "System", "auto": "Everywhere", "joint_box": "Box"}
TITLES = Titles(MODELS, METHODS)
SCORED = ("test", "extrapolation")
#: Nothing to warn of.
NO_MARKS = Marks(
    {name: {} for name in ROBOTS},
    {name: {"is_cut": False} for name in ROBOTS},
    {name: {"findings": []} for name in ROBOTS},
)


def texts(row: Any) -> list[str]:
    """What the cells of a row say."""
    return [cell.text for cell in row]


def kinds(cell: Any) -> list[str]:
    """The badges of a cell."""
    return [mark.kind for mark in cell.marks]


def point_metrics() -> pd.DataFrame:
    rows = []
    for place, (dataset, model, preset, subset) in enumerate(itertools.product(ROBOTS, MODELS, PRESETS, SUBSETS)):
        error = 10.0 ** (place % 9 - 4)
        names = ("rmse_mm", "mae_mm", "r2", "mape_percent", "euclidean_mean_mm", "euclidean_p95_mm")
        row = dict.fromkeys(names, error) | {"fit_seconds": 0.1, "predict_us_per_row": 2.0}
        rows.append({"dataset": dataset, "subset": subset, "model": model, "preset": preset, **row})
    return pd.DataFrame(rows)


def interval_metrics() -> pd.DataFrame:
    rows = []
    for dataset, subset, model, preset, method, level in itertools.product(
        ROBOTS, SCORED, MODELS, PRESETS, METHODS, LEVELS
    ):
        is_region, is_guaranteed = method.startswith("joint"), subset == "test"
        key: dict[str, Any] = {"dataset": dataset, "subset": subset, "model": model, "preset": preset}
        key |= {"interval_method": method, "confidence_level": level}
        marginal = "marginal" if is_guaranteed else "no guarantee"
        # z is constant: it is always covered, and has no guarantee to keep.
        coordinates = (("m1_x", level), ("m1_y", 0.1), ("m1_z", 1.0), ("mean_informative", level))
        for coordinate, coverage in coordinates * (not is_region):
            band = (np.nan, np.nan) if coordinate == "mean_informative" else (level - 0.05, level + 0.05)
            holm = 0.5 if coordinate in ("m1_x", "m1_y") else np.nan
            rows.append(
                key
                | {"coordinate": coordinate, "coverage": coverage, "mean_width_mm": 2.0, "winkler_mm": 3.0}
                | {"winkler_without_gross_mm": 2.5, "n_commands": 40}
                | {"coverage_p_value_holm": holm}
                | {"guarantee": marginal, "coverage_low": band[0], "coverage_high": band[1], "size_mm": np.nan}
            )
        joint = {"coordinate": "joint", "coverage": 0.7, "mean_width_mm": np.nan, "winkler_mm": np.nan}
        joint |= {"guarantee": "joint" if is_guaranteed and is_region else "no guarantee", "size_mm": np.inf}
        rows.append(key | joint | {"coverage_low": 0.6, "coverage_high": 0.8})
    return pd.DataFrame(rows)


def interval_choice() -> pd.DataFrame:
    """Of `arm` the best candidate is deployed; of `finger` it is one on quantile regressors, and the next is."""
    scores = {"confidence_level": 0.9, "cv_winkler_mm": 1.0, "test_coverage": 0.9, "test_mean_width_mm": 2e-7}
    scores |= {"test_winkler_mm": 3.0, "winkler_ratio_to_paper": np.nan}
    scores |= {"extrapolation_coverage": 0.8, "extrapolation_mean_width_mm": 0.5}
    scores |= {"test_winkler_without_gross_mm": 2.5, "winkler_ratio_to_paper_without_gross": np.nan}
    scores |= {"cv_winkler_typical_mm": 0.75, "cv_winkler_without_gross_mm": 0.875}
    scores |= {"extrapolation_commands": 40, "extrapolation_assessable": True}
    rows = []
    for dataset in ROBOTS:
        candidates = [("gb", "cqr")] * (dataset == "finger") + [("gp", "cps"), ("gp", "scp_mapie")]
        for place, (model, method) in enumerate(candidates):
            row = {"dataset": dataset, "model": model, "preset": "tuned", "interval_method": method} | scores
            row |= {"chosen": place == 0, "deployed": method == "cps"}
            rows.append(row | {"outside": "auto" if method == "cps" else method})
    return pd.DataFrame(rows)


def selection() -> pd.DataFrame:
    rows = [{"dataset": d, "model": "gp", "preset": "tuned", "deployed": True, "runner_up": "lr"} for d in ROBOTS]
    return pd.DataFrame(rows).assign(runner_up_ratio=1.25)


def published_comparison() -> pd.DataFrame:
    return pd.DataFrame(
        {"dataset": "arm", "subset": subset, "model": "gb", "metric": metric, "printed": "1.40", "paper_value": 1.4}
        | {"tuned_value": 1.2, "paper_verdict": "reproduced", "tuned_verdict": "better"}
        for subset, metric in itertools.product(SCORED, ("rmse_mm", "r2"))
    )


def published_columns() -> pd.DataFrame:
    columns = published_comparison()[["dataset", "subset", "metric", "printed"]]
    return columns.assign(printed_model="gb", tuned_value=1.2, tuned_model="gp", verdict="worse")


def published_intervals() -> pd.DataFrame:
    row: dict[str, Any] = {"dataset": "arm", "interval_method": "scp_mapie", "metric": "coverage", "printed": "0.90"}
    row |= {"honest_value": 0.5, "honest_verdict": "lower", "nearest_value": 0.9, "nearest_verdict": "reproduced"}
    row |= {"nearest_coordinate": "m1_z", "nearest_model": "gb", "nearest_preset": "paper"}
    return pd.DataFrame([row]).assign(nearest_interval_method="cps", nearest_confidence_level=0.95, nearest_of=840)


def searched_runs() -> pd.DataFrame:
    runs = pd.DataFrame([{"dataset": dataset, "model": "gp", "preset": "tuned"} for dataset in ROBOTS])
    runs = runs.assign(target_space="curvature", cv_mae_mm=1.0, shell_mae_mm=2.0, test_mae_mm=1.0)
    return runs.assign(extrapolation_mae_mm=2.5, cv_rank_correlation=0.25, shell_rank_correlation=0.75)


def extrapolation_intervals() -> pd.DataFrame:
    rows = [{"dataset": d, "model": "gp", "preset": "tuned", "subset": s} for d in ROBOTS for s in SCORED]
    table = pd.DataFrame(rows).assign(interval_method="auto", confidence_level=0.9, coverage=0.91, mean_width_mm=2.0)
    table = table.assign(winkler_mm=3.0, winkler_ratio_to_oracle=1.25, guarantee="no guarantee", labels_used="none")
    table = table.assign(worst_coverage=0.85, joint_coverage=0.7, ratio_low=1.2, ratio_high=1.3, n_commands=40)
    table = table.assign(ratio_without_gross=1.22, assessable=True)
    return table.assign(refused=["", "too few rows"] * len(ROBOTS))


def target_spaces() -> pd.DataFrame:
    rows = pd.DataFrame([{"dataset": d, "model": "gp", "subset": s} for d in ROBOTS for s in SCORED])
    errors = (("cartesian", 4.0), ("curvature", 1.0))
    table = pd.concat([rows.assign(target_space=space, rmse_mm=error) for space, error in errors])
    return table.assign(mae_mm=0.5, is_chosen=table["target_space"] == "curvature")


def recorded() -> pd.DataFrame:
    """Of `finger`: on test without memory and with it, and a next session."""
    row: dict[str, Any] = {
        "dataset": "finger",
        "split": "published",
        "model": "gp",
        "preset": "tuned",
        "subset": "test",
    }
    row |= {"method": "split conformal", "n_recalibration_poses": 0, "mean_width_mm": 1.5, "winkler_mm": 2.2}
    rows: list[dict[str, Any]] = [
        row | {"memory": "none", "rmse_mm": 1.27, "mae_mm": 1.03, "coverage": 0.84},
        row | {"memory": "play", "rmse_mm": 0.53, "mae_mm": 0.42, "coverage": 0.85},
        row
        | {"split": "next_session", "subset": "2 after 1", "memory": "play"}
        | {"rmse_mm": 2.0, "mae_mm": 1.9, "coverage": 0.28},
    ]
    return pd.DataFrame(rows)


def frames() -> dict[str, pd.DataFrame]:
    """Every table of a run, by the name of its CSV."""
    makers = (
        *(point_metrics, interval_metrics, interval_choice, selection, searched_runs, extrapolation_intervals),
        *(target_spaces, published_comparison, published_columns, published_intervals),
    )
    return {make.__name__: make() for make in makers}
