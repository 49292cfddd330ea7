"""One row per run, interval method, subset and level, from the many of interval_metrics."""

from __future__ import annotations

import pandas as pd

from softkin.reporting.tables.numbers import NOTHING
from softkin.uncertainty.intervals.spec import MARGINAL

SCORES = ["coverage", "mean_width_mm", "winkler_mm", "winkler_without_gross_mm", "guarantee"]
RUN = ["dataset", "subset", "model", "preset", "interval_method", "confidence_level"]


def interval_rows(metrics: pd.DataFrame) -> pd.DataFrame:
    """Per run, subset, method and level: the mean over moving coordinates (absent of a region), the joint coverage and
    size, the guarantee, and `as_guaranteed`: how many coordinates, or whether all at once, keep it.
    """
    keyed = metrics.set_index(RUN)
    mean = keyed[keyed["coordinate"] == "mean_informative"][SCORES]
    joint = keyed[keyed["coordinate"] == "joint"]
    wide = joint[["coverage", "size_mm"]].rename(columns={"coverage": "joint_coverage"}).join(mean)
    wide["guarantee"] = wide["guarantee"].fillna(joint["guarantee"])
    wide["as_guaranteed"] = _coordinates_in_band(keyed[keyed["guarantee"] == MARGINAL]).reindex(wide.index)
    regions = _in_band(joint[joint["guarantee"] == "joint"]).map({True: "yes", False: "no"})
    wide["as_guaranteed"] = wide["as_guaranteed"].fillna(regions.reindex(wide.index))
    return wide.fillna({"as_guaranteed": NOTHING}).reset_index()


def _coordinates_in_band(marginal: pd.DataFrame) -> pd.Series:
    """'17 of 18' moving coordinates in their band, per run; a constant coordinate has no corrected p-value."""
    in_band = _in_band(marginal[marginal["coverage_p_value_holm"].notna()])
    counts = in_band.groupby(level=RUN).agg(["sum", "size"]).astype(str)
    return counts["sum"] + " of " + counts["size"]


def _in_band(rows: pd.DataFrame) -> pd.Series:
    """Whether the coverage of each row lies where its guarantee allows."""
    return rows["coverage"].between(rows["coverage_low"] - 1e-9, rows["coverage_high"] + 1e-9)
