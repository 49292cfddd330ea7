"""What the run says at its end: per dataset the chosen model and its errors, and how the paper's cells fared."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.reporting.tables.interval_choice import given_intervals
from softkin.reporting.tables.paper_layout import format_number

AIMS = {
    "interpolation": "commands like those of train",
    "extrapolation": "commands beyond those of train",
    "both": "commands like those of train and beyond",
}


def headline(
    selected: pd.DataFrame | None,
    point: pd.DataFrame,
    intervals: pd.DataFrame,
    sentences: Sequence[str],
    leaking: Sequence[str] = (),
) -> str:
    """Plain text, under 80 columns; `leaking` names the datasets whose test rows stand in train."""
    wide = 2 + max(18, *map(len, intervals["dataset"]))
    lines = ["", "softkin: forward kinematics, mean error of a marker position (mm)", ""]
    if selected is not None:
        lines.append(f"  {'dataset':<{wide}}{'model':<14}{'test':>10}{'95 %':>10}{'extrapolation':>16}")
        remarks: list[str] = []
        scores = point.set_index(["dataset", "model", "preset", "subset"])
        for row in selected.itertuples():
            test = scores.loc[(row.dataset, row.model, row.preset, TEST)]
            outside = scores.loc[(row.dataset, row.model, row.preset, EXTRAPOLATION)]
            numbers = (test["euclidean_mean_mm"], test["euclidean_p95_mm"], outside["euclidean_mean_mm"])
            texts = [format_number(number) for number in numbers]
            model = f"{row.model} {row.preset}"
            lines.append(f"  {row.dataset:<{wide}}{model:<14}{texts[0]:>10}{texts[1]:>10}{texts[2]:>16}")
            if numbers[0] > numbers[1]:
                remarks.append(f"  {row.dataset}: a few gross misses set the mean, which exceeds the 95th percentile.")
        remarks += [f"  {dataset}: LEAK. Its test rows stand in train, see its data card." for dataset in leaking]
        objective = selected["objective"].iloc[0]
        lines += ["", f"  The model is chosen for {AIMS[objective]}, on `train` alone.", *remarks]
    lines += _how_sure(intervals, wide)
    lines += [f"  {sentence}" for sentence in sentences]
    lines += [
        "",
        "  results/report.html      the whole run on one page",
        "  results/tables/          the tables, as CSV, Markdown and LaTeX",
        "  results/tables/paper_tables.md   the paper's Tables 2 to 6 beside ours",
        "  make ui                  browse every run in the MLflow UI",
        "",
    ]
    return "\n".join(lines)


def _how_sure(intervals: pd.DataFrame, wide: int) -> list[str]:
    """Per dataset the interval of its calibrated model: what surrounds a coordinate, how wide, how often it covers
    `test`; and how often extrapolation.
    """
    given = given_intervals(intervals)
    level = given["confidence_level"].iloc[0]
    lines = ["", f"  how sure: {level:.0%} intervals, mean over coordinates", ""]
    lines.append(f"  {'dataset':<{wide}}{'around':<14}{'method':<16}{'width (mm)':>12}{'test':>8}{'beyond':>9}")
    for row in given.itertuples():
        around = f"{row.model} {row.preset}"
        width = format_number(row.test_mean_width_mm)
        lines.append(
            f"  {row.dataset:<{wide}}{around:<14}{row.interval_method:<16}{width:>12}{row.test_coverage:>8.1%}"
            f"{row.extrapolation_coverage:>9.1%}"
        )
    lines += ["", "  The method is chosen, and calibrated, on `validation` alone. Beyond the training region"]
    return [*lines, "  intervals are widened by what shells of `train` show, and nothing is promised.", ""]
