"""Compare the 24 printed cells of the paper's Table 6 with ours: an average over coordinates, and the nearest cell."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from softkin.core.runs import PAPERS_LEVEL
from softkin.core.samples import TEST
from softkin.models.spec import PAPERS_RUN
from softkin.reporting.tables.numbers import NOTHING, number_text
from softkin.reporting.tables.paper_layout import PaperTable
from softkin.reporting.tables.verdicts import unit
from softkin.reporting.titles import Titles

KEY = ["dataset", "interval_method"]
METRICS = {"coverage": "Coverage", "winkler_mm": "Winkler score (mm)"}
AVERAGES = ("mean", "mean_informative", "joint")
#: What a printed column may have been: its package's methods.
MAY_BE = {
    "qr": ("qr",),
    "cqr": ("cqr", "cqr_asymmetric"),
    "scp_mapie": ("scp_mapie", "cv_plus", "jackknife_plus_ab"),
    "scp_crepes": ("scp_crepes", "cps"),
}
COLUMNS = (
    *("dataset", "interval_method", "metric", "printed", "honest_value", "honest_verdict", "nearest_value"),
    *("nearest_verdict", "nearest_coordinate", "nearest_model", "nearest_preset", "nearest_interval_method"),
    *("nearest_confidence_level", "nearest_of", "explanation"),
)
NEAREST = ("coordinate", "model", "preset", "interval_method", "confidence_level")


def read_published_intervals(path: str | Path) -> pd.DataFrame:
    """The printed cells: dataset, interval_method, coverage, winkler_mm, as text."""
    return pd.read_csv(path, dtype=str).rename(columns={"method": "interval_method"})


def compare_intervals(published: pd.DataFrame, metrics: pd.DataFrame, point: pd.DataFrame) -> pd.DataFrame:
    """Two rows (coverage, Winkler score) per printed dataset and method that was run.

    `honest` is the paper's run at 90 % on `test`, averaged over moving coordinates: the comparison. `nearest` is the
    single coordinate, model, preset, method of the same package and level whose coverage and Winkler score together
    come nearest, out of `nearest_of` combinations: a search of that freedom finds something near any print.
    """
    test = metrics[metrics["subset"] == TEST]
    rows = []
    for printed in published.to_dict("records"):
        of_dataset = test[test["dataset"] == printed["dataset"]]
        honest = of_dataset[
            (of_dataset["interval_method"] == printed["interval_method"])
            & (of_dataset["model"] == PAPERS_RUN.model)
            & (of_dataset["preset"] == PAPERS_RUN.preset)
            & (of_dataset["confidence_level"] == PAPERS_LEVEL)
            & (of_dataset["coordinate"] == "mean_informative")
        ]
        if honest.empty:
            continue
        similar = of_dataset[of_dataset["interval_method"].isin(MAY_BE[printed["interval_method"]])]
        single = _comparable(similar[~similar["coordinate"].isin(AVERAGES)])
        nearest = _nearest(single, printed)
        for metric in METRICS:
            ours = float(honest.iloc[0][metric])
            rows.append(
                {
                    **{key: printed[key] for key in KEY},
                    "metric": metric,
                    "printed": printed[metric],
                    "honest_value": ours,
                    "honest_verdict": _verdict(printed[metric], ours),
                    "nearest_value": float(nearest[metric]),
                    "nearest_verdict": _verdict(printed[metric], float(nearest[metric])),
                    **{f"nearest_{key}": nearest[key] for key in NEAREST},
                    "nearest_of": len(single),
                    "explanation": _explanation(printed, ours, metric, nearest, point),
                }
            )
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _comparable(rows: pd.DataFrame) -> pd.DataFrame:
    """Rows whose Winkler score is a finite number above 0."""
    return rows[np.isfinite(rows["winkler_mm"]) & (rows["winkler_mm"] > 0)]


def _nearest(rows: pd.DataFrame, printed: dict[str, str]) -> pd.Series:
    """The row nearest to the printed cells; its distance is coverage in hundredths plus Winkler score in twentieths of
    itself.
    """
    coverage = (rows["coverage"] - float(printed["coverage"])).abs() / 0.01
    winkler = np.log(rows["winkler_mm"] / float(printed["winkler_mm"])).abs() / 0.05
    return rows.loc[(coverage + winkler).idxmin()]


def _verdict(printed: str, ours: float) -> str:
    if abs(ours - float(printed)) <= unit(printed) * (1 + 1e-9):
        return "reproduced"
    return "higher" if ours > float(printed) else "lower"


def _explanation(printed: dict[str, str], ours: float, metric: str, nearest: pd.Series, point: pd.DataFrame) -> str:
    nearest_text = (
        f"nearest single coordinate: {nearest['coordinate']}, {nearest['model']} {nearest['preset']}, "
        f"{nearest['interval_method']} at {nearest['confidence_level']:.0%}"
    )
    if metric != "winkler_mm" or not printed["interval_method"].startswith("scp"):
        return f"average over moving coordinates {_rounded(ours)}; {nearest_text}"
    on_test = (point["dataset"] == printed["dataset"]) & (point["subset"] == TEST)
    scores = point[on_test & (point["model"] == PAPERS_RUN.model) & (point["preset"] == PAPERS_RUN.preset)]
    least = 2 * float(scores["mae_informative_mm"].iloc[0])
    bound = f"an average cannot be below 2 MAE = {_rounded(least)} mm"
    verdict = (
        "so the printed score is no average" if float(printed[metric]) < least else "which the printed score keeps"
    )
    return f"average over moving coordinates {_rounded(ours)}; {bound}, {verdict}; {nearest_text}"


def _rounded(value: float) -> str:
    """Three significant digits, with an exponent where small: the format of published_intervals.csv."""
    if value == 0 or not np.isfinite(value):
        return str(value)
    decimals = max(0, 2 - int(np.floor(np.log10(abs(value)))))
    return f"{value:.{decimals}f}" if decimals <= 5 else f"{value:.2e}"


def table_6(cells: pd.DataFrame, dataset_titles: Mapping[str, str], titles: Titles) -> PaperTable:
    """Table 6 in the paper's layout: printed beside our average over moving coordinates."""
    methods = [method for method in titles.methods if method in set(cells["interval_method"])]
    header = ["Metric", *(f"{titles.methods[m]} {source}" for m in methods for source in ("printed", "ours"))]
    rows, groups = [], []
    for dataset, of_dataset in cells.groupby("dataset", sort=False):
        for metric, heading in METRICS.items():
            row = [heading]
            for method in methods:
                cell = of_dataset[(of_dataset["interval_method"] == method) & (of_dataset["metric"] == metric)]
                row += (
                    [cell["printed"].iloc[0], number_text(cell["honest_value"].iloc[0])] if len(cell) else [NOTHING] * 2
                )
            rows.append(row)
        groups.append((dataset_titles[str(dataset)], len(METRICS)))
    notes = [
        "Ours: gradient boosting in the paper preset, nominal level 90 %, test rows, averaged over the moving "
        "coordinates. The printed cells are almost surely one coordinate each, and the two SCP columns not of one "
        "level: calibrated alike, MAPIE and crepes give the same interval. published_intervals.csv names what comes "
        "nearest, and out of how many combinations: so free a search proves nothing."
    ]
    return PaperTable("Table 6: conformal prediction and quantile regression", header, rows, set(), groups, notes)
