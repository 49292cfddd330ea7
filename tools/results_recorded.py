"""Section of the results page on robots whose recording order is known."""

from __future__ import annotations

from typing import Any

import pandas as pd

from softkin.reporting.page.recorded import SPLITS
from softkin.reporting.tables.numbers import number_text, share_text
from tools.finished_run import FinishedRun, table

HEADER = ["Robot", "Split", "Rows", "Memory", "Interval", "Labelled poses", "RMSE / MAE (mm)", "Coverage", "Width (mm)"]


def robots_in_time(run: FinishedRun) -> dict[str, Any]:
    """Scores in time, and the claims that they decide; empty tables where no robot is recorded."""
    files = {name: run.results / "tables" / f"{name}.csv" for name in ("recorded", "claims")}
    recorded, claims = (pd.read_csv(file) if file.is_file() else pd.DataFrame() for file in files.values())
    rows = [
        [
            *(run.name(row.dataset), SPLITS[row.split], row.subset, row.memory, row.method),
            *(str(row.n_recalibration_poses), f"{number_text(row.rmse_mm)} / {number_text(row.mae_mm)}"),
            *(share_text(row.coverage), number_text(row.mean_width_mm)),
        ]
        for row in recorded.itertuples()
    ]
    sentences = [
        f'*{run.name(row.dataset)}*: "{row.claim}" ({row.source}) **{row.verdict}**: {row.numbers}.'
        for row in claims.itertuples()
    ]
    return {"recorded": table(HEADER, rows) if rows else "", "claims": "\n\n".join(sentences)}
