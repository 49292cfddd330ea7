"""Compare every printed cell of the paper's Tables 3 to 5 with ours, and the best of each column."""

from __future__ import annotations

import math
from pathlib import Path

import pandas as pd

from softkin.core.metrics.point import LARGER_IS_BETTER
from softkin.core.runs import PAPER, PRESETS, TUNED
from softkin.reporting.tables.verdicts import BETTER, REPRODUCED, verdict

KEY = ["dataset", "subset", "model"]


def read_published(path: str | Path) -> pd.DataFrame:
    """The printed cells in long form: dataset, subset, model, metric, printed (text, as printed)."""
    wide = pd.read_csv(path, dtype=str)
    return wide.melt(id_vars=KEY, value_vars=list(LARGER_IS_BETTER), var_name="metric", value_name="printed")


def compare(published: pd.DataFrame, point: pd.DataFrame, notes: dict[tuple[str, str], str]) -> pd.DataFrame:
    """One row per printed cell whose dataset and model were run, with value and verdict of each preset.

    `notes` says (dataset, subset) -> what a reader must know about that table.
    """
    ours = point.melt(id_vars=[*KEY, "preset"], value_vars=list(LARGER_IS_BETTER), var_name="metric")
    wide = ours.pivot_table(index=[*KEY, "metric"], columns="preset", values="value", dropna=False).reset_index()
    cells = published.merge(wide, on=[*KEY, "metric"], how="inner")
    for preset in [preset for preset in PRESETS if preset in wide]:
        cells[f"{preset}_verdict"] = [
            "" if math.isnan(value) else verdict(printed, value, metric)
            for printed, value, metric in zip(cells["printed"], cells[preset], cells["metric"], strict=True)
        ]
    cells["note"] = [notes.get(key, "") for key in zip(cells["dataset"], cells["subset"], strict=True)]
    return cells.rename(columns={preset: f"{preset}_value" for preset in PRESETS})


def compare_columns(cells: pd.DataFrame, point: pd.DataFrame) -> pd.DataFrame:
    """One row per column of the paper's tables: its best printed cell against our best tuned model, be it one of the
    paper's or another of the pool.
    """
    tuned = point[point["preset"] == TUNED].set_index(["dataset", "subset"])
    rows = []
    for (dataset, subset, metric), column in cells.groupby(["dataset", "subset", "metric"], sort=False):
        larger = LARGER_IS_BETTER[str(metric)]
        printed = column["printed"].astype(float)
        best_printed = column.loc[printed.idxmax() if larger else printed.idxmin()]
        pool = tuned.loc[[(dataset, subset)]].set_index("model")[str(metric)]
        best_model = pool.idxmax() if larger else pool.idxmin()
        rows.append(
            {
                "dataset": dataset,
                "subset": subset,
                "metric": metric,
                "printed": best_printed["printed"],
                "printed_model": best_printed["model"],
                "tuned_value": pool[best_model],
                "tuned_model": best_model,
                "verdict": verdict(best_printed["printed"], pool[best_model], str(metric)),
                "note": best_printed["note"],
            }
        )
    columns = [
        "dataset",
        "subset",
        "metric",
        "printed",
        "printed_model",
        "tuned_value",
        "tuned_model",
        "verdict",
        "note",
    ]
    return pd.DataFrame(rows, columns=columns)


def count_verdicts(verdicts: pd.Series, wanted: tuple[str, ...]) -> str:
    """'176 of 192'."""
    return f"{int(verdicts.isin(wanted).sum())} of {len(verdicts)}"


def summary(cells: pd.DataFrame, columns: pd.DataFrame | None) -> list[str]:
    """The counts a reader asks for first, one sentence each."""
    if cells.empty:
        return ["nothing was run that the paper has printed"]
    lines = []
    if f"{PAPER}_verdict" in cells:
        lines.append(f"paper preset: {count_verdicts(cells['paper_verdict'], (REPRODUCED,))} printed cells reproduced")
    if columns is not None:
        tuned = count_verdicts(cells["tuned_verdict"], (BETTER,))
        best = count_verdicts(columns["verdict"], (BETTER, REPRODUCED))
        lines.append(f"tuned preset: {tuned} printed cells beaten by the same model")
        lines.append(f"tuned preset: {best} columns where our best is at least the paper's best")
    return lines
