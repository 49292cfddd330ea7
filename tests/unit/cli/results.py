"""A small folder of results: one robot, two runs, one interval method, tables across datasets, and their records."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from softkin.core.bounds import bounds_frame
from softkin.core.files import write_json
from softkin.core.job_records import record_job
from softkin.core.metrics.interval import covered, widths, winkler_scores
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, coordinate_columns
from softkin.data.table import to_table, write_table
from softkin.evaluation.score_points import score_points
from tests.conftest import four_subsets

RUNS = (Run("lr", "paper"), Run("lr", "tuned"))


def write_results(results: Path) -> None:
    """Write the folder `results`."""
    arm = results / "arm"
    subsets = four_subsets(dict.fromkeys(SUBSETS, 30))
    names = coordinate_columns(1)
    for place, run in enumerate(RUNS):
        folder = arm / run.model / run.preset
        folder.mkdir(parents=True)
        parts = [pd.DataFrame(rows.positions + place + 0.5, columns=names) for rows in subsets.values()]
        predictions = pd.concat([part.assign(subset=s) for s, part in zip(subsets, parts, strict=True)])
        predictions.to_parquet(folder / "predictions.parquet")
        write_json(folder / "fit.json", {"fit_seconds": 1.0, "predict_us_per_row": 2.0})
        (folder / "model.joblib").write_bytes(b"a model")
        record_job(results / "logs" / "fit_model" / "arm" / f"{run.preset}.log", [*folder.iterdir()])
    write_table(to_table(subsets), arm / "table.parquet")
    score_points(
        arm / "table.parquet",
        dataset="arm",
        predictions={run: arm / run.model / run.preset / "predictions.parquet" for run in RUNS},
        records={run: arm / run.model / run.preset / "fit.json" for run in RUNS},
        point=arm / "point_metrics.csv",
        markers=arm / "marker_errors.csv",
    )
    rows, frames = [], []
    for subset in ("test", "extrapolation"):
        true = subsets[subset].positions
        bounds = np.stack([true - 1.0, true + np.linspace(-0.1, 2.0, len(true))[:, None]], axis=-1)
        frames.append(bounds_frame(bounds, subset, 0.9).assign(**RUNS[0]._asdict()))
        scores = (covered(true, bounds), widths(bounds), winkler_scores(true, bounds, 0.9))
        means = [part.mean(axis=0) for part in scores]
        for column, name in enumerate(names):
            key = {"dataset": "arm", "subset": subset, **RUNS[0]._asdict(), "interval_method": "scp"}
            values = dict(zip(("coverage", "mean_width_mm", "winkler_mm"), (m[column] for m in means), strict=True))
            rows.append(key | {"confidence_level": 0.9, "coordinate": name} | values)
    (arm / "intervals").mkdir()
    pd.concat(frames).to_parquet(arm / "intervals" / "scp.parquet")
    pd.DataFrame(rows).to_csv(arm / "interval_metrics.csv", index=False)
    (results / "tables").mkdir()
    for name in ("point_metrics", "marker_errors", "interval_metrics"):
        frame = pd.read_csv(arm / f"{name}.csv")
        frame.assign(leak=False).to_csv(results / "tables" / f"{name}.csv", index=False)
    made = [arm / "table.parquet", *arm.glob("*.csv"), arm / "intervals" / "scp.parquet"]
    record_job(results / "logs" / "score" / "arm.log", made)
    record_job(results / "logs" / "build_tables.log", [*(results / "tables").iterdir()])
