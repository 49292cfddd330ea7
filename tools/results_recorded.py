"""Section of the results page on robots whose recording order is known."""

from __future__ import annotations

from typing import Any

import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.evaluation.recorded_names import BLOCKS
from softkin.reporting.page.recorded import SPLITS
from softkin.reporting.tables.numbers import number_text, share_text
from tools.finished_run import FinishedRun, table

HEADER = ["Robot", "Split", "Rows", "Memory", "Interval", "Labelled poses", "RMSE / MAE (mm)", "Coverage", "Width (mm)"]


def robots_in_time(run: FinishedRun) -> dict[str, Any]:
    """Scores in time; an empty table where no robot is recorded."""
    file = run.results / "tables" / "recorded.csv"
    recorded = read_csv(file) if file.is_file() else pd.DataFrame()
    rows = [
        [
            *(run.name(row.dataset), SPLITS[row.split], row.subset, row.memory, row.method),
            *(str(row.n_recalibration_poses), f"{number_text(row.rmse_mm)} / {number_text(row.mae_mm)}"),
            *(share_text(row.coverage), number_text(row.mean_width_mm)),
        ]
        for row in recorded.itertuples()
        if row.split not in BLOCKS.values()
    ]
    return {"recorded": table(HEADER, rows) if rows else "", "in_parts": _in_parts(run, recorded) if rows else ""}


def _in_parts(run: FinishedRun, recorded: pd.DataFrame) -> str:
    """Coverage and mean width (mm) of each method by session and block of time, of what the deployed run is told."""
    parts = recorded[recorded["split"].isin(BLOCKS.values())]
    told = parts[parts["memory"] != "none"]
    parts = parts if told.empty else told
    key = ["dataset", "split", "memory", "subset"]
    methods = list(dict.fromkeys(parts["method"]))
    rows = []
    for (dataset, split, memory, subset), of_part in parts.groupby(key, sort=False):
        by_method = of_part.set_index("method")
        scores = [
            f"{share_text(row.coverage)} at {number_text(row.mean_width_mm)}"
            for row in by_method.loc[methods].itertuples()
        ]
        rows.append([run.name(dataset), SPLITS[split], subset, memory, *scores])
    return table(["Robot", "Split", "Rows", "Memory", *methods], rows)
