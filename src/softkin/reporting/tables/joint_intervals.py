"""Tabulate the joint intervals of the calibrated models: how often they hold whole poses, and intervals do."""

from __future__ import annotations

import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.uncertainty.regions.spec import JOINT_INTERVALS


def joint_scores(metrics: pd.DataFrame, deployed: pd.DataFrame) -> pd.DataFrame:
    """Indexed by dataset: `shape`, `size_mm` on test, `test` and `extrapolation`, the shares of whole poses that joint
    intervals hold, `single_test` and `single_extrapolation`, those that the deployed intervals do, and whether
    extrapolation is `assessable`.

    Parameters:
        metrics: as in interval_metrics.csv.
        deployed: the deployed intervals, indexed by dataset.
    """
    joint = metrics[metrics["coordinate"] == "joint"]
    rows = {}
    for dataset, best in deployed.iterrows():
        of_run = joint[(joint[["dataset", "model", "preset"]] == best[["dataset", "model", "preset"]]).all(axis=1)]
        of_run = of_run[of_run["confidence_level"] == best["confidence_level"]].set_index(["interval_method", "subset"])
        if (JOINT_INTERVALS, TEST) not in of_run.index:
            continue
        test = of_run.loc[(JOINT_INTERVALS, TEST)]
        rows[dataset] = {
            "shape": test["shape"],
            "size_mm": test["size_mm"],
            "test": test["coverage"],
            "extrapolation": of_run.loc[(JOINT_INTERVALS, EXTRAPOLATION), "coverage"],
            "assessable": best["extrapolation_assessable"],
            "single_test": of_run.loc[(best["interval_method"], TEST), "coverage"],
            "single_extrapolation": of_run.loc[(best["outside"], EXTRAPOLATION), "coverage"],
        }
    return pd.DataFrame.from_dict(rows, orient="index")
