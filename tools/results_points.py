"""Sections of the results page on data and point models; each function returns names -> tables, counts, sentences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pandas as pd

from softkin.core.runs import PRESETS
from softkin.core.samples import EXTRAPOLATION, SUBSETS
from softkin.data.audit.findings import LEAK
from softkin.reporting.tables.numbers import number_text, share_text
from softkin.reporting.tables.single_rows import SHARE, Number
from softkin.reporting.tables.verdicts import BETTER, REPRODUCED, WORSE
from tools.finished_run import TITLES, FinishedRun, table

METRICS = {"rmse_mm": "RMSE (mm)", "mae_mm": "MAE (mm)", "r2": "R2", "mape_percent": "MAPE (%)"}


def data(run: FinishedRun) -> dict[str, Any]:
    """The robots, and the leaks that the audit found."""
    rows: list[list[str]] = []
    leaks: list[str] = []
    for dataset in run.datasets:
        description = run.description(dataset)
        sizes = [str(description["rows"][subset]) for subset in SUBSETS]
        robot = [str(description[key]) for key in ("title", "n_commands", "n_markers")]
        rows.append([*robot, *sizes, f"`{str(description['sha256'])[:12]}`"])
        leaks += [
            f"{run.name(dataset)}: {finding['sentence']} {finding['consequence']}"
            for finding in run.card(dataset)["findings"]
            if finding["severity"] == LEAK
        ]
    return {"robots": table(["Robot", "Commands", "Markers", *SUBSETS, "SHA-256"], rows), "leaks": leaks}


def printed_cells(run: FinishedRun) -> dict[str, Any]:
    """What holds of the paper's printed cells; no more than that there are none, where nothing of the paper was run."""
    cells = run.tables.read("published_comparison", "printed")
    if cells.empty:
        return {"n_cells": 0}
    columns = run.tables.read("published_columns", "printed")
    return {
        "n_cells": len(cells),
        "n_reproduced": int((cells["paper_verdict"] == REPRODUCED).sum()),
        "n_beaten": int((cells["tuned_verdict"] == BETTER).sum()),
        "n_tied": int((cells["tuned_verdict"] == REPRODUCED).sum()),
        "n_columns": len(columns),
        "n_best": int(columns["verdict"].isin([BETTER, REPRODUCED]).sum()),
        "not_reproduced": _cells(run, cells[cells["paper_verdict"] != REPRODUCED], ["paper"]),
        "not_beaten": _cells(run, cells[cells["tuned_verdict"] == WORSE], PRESETS),
        "best": _best_of_columns(run, columns),
        "constant": [run.name(name) for name in run.datasets if run.description(name)["constant_coordinates"]],
    }


def _cells(run: FinishedRun, cells: pd.DataFrame, presets: Sequence[str]) -> str:
    """Printed cells beside ours."""
    presets = [preset for preset in presets if f"{preset}_value" in cells]
    rows = [
        [
            *(run.name(row["dataset"], row["subset"]), row["subset"]),
            *(TITLES.models[row["model"]], METRICS[row["metric"]], row["printed"]),
            *(number_text(row[f"{preset}_value"]) for preset in presets),
        ]
        for row in cells.to_dict("records")
    ]
    return table(["Robot", "Subset", "Model", "Metric", "Printed", *(f"Ours, {name}" for name in presets)], rows)


def _best_of_columns(run: FinishedRun, columns: pd.DataFrame) -> str:
    """The best printed cell of each column beside our best tuned model."""
    rows = [
        [
            *(run.name(row["dataset"], row["subset"]), row["subset"], METRICS[row["metric"]]),
            f"{row['printed']} ({TITLES.models[row['printed_model']]})",
            f"{number_text(row['tuned_value'])} ({TITLES.models[row['tuned_model']]})",
            str(row["verdict"]),
        ]
        for row in columns.to_dict("records")
    ]
    return table(["Robot", "Subset", "Metric", "The paper's best", "Our best, tuned", "Verdict"], rows)


def points_in_extrapolation(run: FinishedRun) -> dict[str, Any]:
    """The deployed models in extrapolation, how well scores on `train` ranked them, what target spaces are worth."""
    deployed = run.tables.deployed_in_extrapolation()
    studies = run.tables.read("searched_runs")["target_space"]
    ratios = run.tables.space_ratios()
    return {
        "deployed": _deployed(run, deployed),
        "n_robots": int(deployed["shell_rank_correlation"].notna().sum()),
        "n_ranked_by_shells": int((deployed["shell_rank_correlation"] > deployed["cv_rank_correlation"]).sum()),
        "n_studies": len(studies),
        "single_row_share": share_text(SHARE, 0),
        "n_curvature": int((studies == "curvature").sum()),
        "n_ratios": int(ratios.notna().sum().sum()),
        "n_gains": int((ratios < 1).sum().sum()),
        "ratios": table(
            ["Model", *(run.name(str(dataset)) for dataset in ratios)],
            ([TITLES.models[str(model)], *map(number_text, row)] for model, row in ratios.iterrows()),
        ),
    }


def _deployed(run: FinishedRun, deployed: pd.DataFrame) -> str:
    columns = run.tables.read("published_columns", "printed")
    printed = columns.set_index(["dataset", "subset", "metric"])["printed"].to_dict()
    rows = []
    for row in deployed.to_dict("records"):
        dataset, errors = row["dataset"], ("rmse_mm", "mae_mm")
        papers = [printed.get((dataset, EXTRAPOLATION, metric), number_text(None)) for metric in errors]
        keys = [Number(dataset, EXTRAPOLATION, row["model"], row["preset"], metric) for metric in errors]
        rows.append(
            [
                *(run.name(dataset, EXTRAPOLATION), TITLES.run(row["model"], row["preset"]), row["target_space"]),
                " / ".join(run.starred(row[key.metric], key) for key in keys),
                " / ".join(papers),
                *(number_text(row[f"{score}_rank_correlation"]) for score in ("shell", "cv")),
            ]
        )
    header = [
        "Robot",
        "Deployed",
        "Target space",
        "RMSE / MAE (mm)",
        "The paper's best",
        "Outer shells",
        "Cross-validation",
    ]
    return table(header, rows)
