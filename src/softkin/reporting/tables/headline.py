"""Write the headline of a run: per dataset the deployed model, its errors and intervals, and the counts of verdicts."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

import pandas as pd

from softkin.core.escaping import one_line
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.reporting.tables.interval_choice import chosen_intervals, deployed_intervals
from softkin.reporting.tables.numbers import number_text, share_text

WIDTH = 90
AIMS = {
    "interpolation": "commands like those of train",
    "extrapolation": "commands beyond those of train",
    "both": "commands like those of train and beyond",
}
FILES = (
    "  results/report.html      the whole run on one page",
    "  results/tables/          the tables, as CSV, Markdown and LaTeX",
    "  results/tables/paper_tables.md   the paper's Tables 2 to 6 beside ours",
    "  make ui                  browse every run in the MLflow UI",
)


def headline(
    selected: pd.DataFrame | None,
    point: pd.DataFrame,
    choice: pd.DataFrame,
    sentences: Sequence[str],
    leaking: Sequence[str] = (),
    caution: str | None = None,
) -> str:
    """Plain text of at most `WIDTH` columns.

    Parameters:
        selected: the deployed run of each dataset; None where nothing was searched.
        point: as in point_metrics.csv.
        choice: as in interval_choice.csv.
        sentences: how the paper's cells compare with ours.
        leaking: datasets whose test rows stand in train.
        caution: what the configuration says of its own numbers.
    """
    width = 2 + max(18, *map(len, choice["dataset"]))
    lines = ["", "softkin: forward kinematics, mean error of a marker position (mm)", ""]
    if caution:
        lines += [
            *textwrap.wrap(f"CAUTION: {one_line(caution)}", WIDTH, initial_indent="  ", subsequent_indent="  "),
            "",
        ]
    if selected is not None:
        lines += _errors(selected, point, leaking, width)
    lines += _intervals(choice, width)
    lines += [f"  {sentence}" for sentence in sentences]
    return "\n".join([*lines, "", *FILES, ""])


def _errors(selected: pd.DataFrame, point: pd.DataFrame, leaking: Sequence[str], width: int) -> list[str]:
    """Lines on the errors of the deployed models."""
    lines = [f"  {'dataset':<{width}}{'model':<14}{'test':>13}{'95 % below':>13}{'extrapolation':>15}"]
    remarks = []
    scores = point.set_index(["dataset", "model", "preset", "subset"])
    for row in selected.itertuples():
        test, extrapolation = (
            scores.loc[(row.dataset, row.model, row.preset, subset)] for subset in (TEST, EXTRAPOLATION)
        )
        mean, p95 = test["euclidean_mean_mm"], test["euclidean_p95_mm"]
        model, beyond = f"{row.model} {row.preset}", number_text(extrapolation["euclidean_mean_mm"])
        lines.append(f"  {row.dataset:<{width}}{model:<14}{number_text(mean):>13}{number_text(p95):>13}{beyond:>15}")
        if mean > p95:
            remarks.append(f"  {row.dataset}: a few gross errors set the mean, which exceeds the 95th percentile.")
    remarks += [f"  {dataset}: LEAK. Its test rows stand in train, see its data card." for dataset in leaking]
    aim = AIMS[selected["objective"].iloc[0]]
    return [*lines, "", f"  The model is chosen for {aim}, on `train` alone.", *remarks]


def _intervals(choice: pd.DataFrame, width: int) -> list[str]:
    """Lines on the interval of each calibrated model: method, mean width, coverage on test and on extrapolation."""
    deployed = deployed_intervals(choice)
    level = share_text(deployed["confidence_level"].iloc[0], 0)
    lines = ["", f"  {level} intervals of the calibrated models, mean over moving coordinates", ""]
    columns = f"{'around':<14}{'method':<14}{'width (mm)':>13}{'test':>9}{'extrapolation':>15}"
    lines.append(f"  {'dataset':<{width}}{columns}")
    for row in deployed.itertuples():
        run, size = f"{row.model} {row.preset}", number_text(row.test_mean_width_mm)
        shares = f"{share_text(row.test_coverage):>9}{share_text(row.extrapolation_coverage):>15}"
        lines.append(f"  {row.dataset:<{width}}{run:<14}{row.interval_method:<14}{size:>13}{shares}")
    lines += ["", "  The method is the best around that model, chosen and calibrated on `validation`."]
    lines += ["  In extrapolation nothing is guaranteed; outer shells of `train` widen intervals."]
    return [*lines, *_not_deployed(choice), ""]


def _not_deployed(choice: pd.DataFrame) -> list[str]:
    """Lines on chosen methods that are not deployed."""
    chosen = chosen_intervals(choice)
    return [
        f"  {row.dataset}: chosen is {row.interval_method} ({row.model} {row.preset}), which surrounds no point model."
        for row in chosen[~chosen["deployed"]].itertuples()
    ]
