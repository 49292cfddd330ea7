"""The tables on extrapolation: scores on `train` beside errors, target spaces, and intervals beside an oracle."""

from __future__ import annotations

import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.reporting.page.choices import Choices
from softkin.reporting.page.grid import Cell, Column, Grid, filtered_columns, number, number_columns, share
from softkin.reporting.page.marks import Marks
from softkin.reporting.tables.numbers import NOT_ASSESSABLE, band_text, number_text, share_text
from softkin.reporting.titles import Titles

#: What is compared with what.
SPACES = ("cartesian", "curvature")
SUBSET = Column("Rows", filtered=True, preset=EXTRAPOLATION)


def searched_grid(runs: pd.DataFrame, titles: Titles, marks: Marks, choices: Choices) -> Grid:
    """One row per searched run: its scores on train, its errors, and its target space; the deployed run is marked."""
    rows = [
        [
            Cell(row.dataset, marks.of(row.dataset, TEST)),
            Cell(titles.models[row.model], choices.of_run(row.dataset, row.model, row.preset)),
            *map(Cell, (row.preset, row.target_space)),
            *map(number, (row.cv_mae_mm, row.shell_mae_mm, row.test_mae_mm, row.extrapolation_mae_mm)),
        ]
        for row in runs.itertuples()
    ]
    correlations = [
        f"{dataset} {number_text(first['shell_rank_correlation'])} ({number_text(first['cv_rank_correlation'])})"
        for dataset, first in runs.groupby("dataset", sort=False).first().iterrows()
    ]
    sentence = (
        "Runs are chosen by two scores on train alone: cross-validation, for commands like those of train, and outer "
        "shells of train, for commands beyond them. Spearman's rank correlation of the shell score with the error on "
        "extrapolation rows (that of cross-validation in brackets): " + ", ".join(correlations) + "."
    )
    columns = filtered_columns("Robot", "Model", "Preset", "Target space")
    columns += number_columns(
        "Cross-validation ({unit})",
        "Outer shells ({unit})",
        "MAE, test ({unit})",
        "MAE, extrapolation ({unit})",
        unit=marks.unit,
    )
    return Grid("searched", "Scores on train beside errors", sentence, columns, rows, "tables/searched_runs.csv")


def spaces_grid(spaces: pd.DataFrame, titles: Titles, marks: Marks) -> Grid:
    """One row per model and subset: its errors in curvature coordinates beside those in positions."""
    key = ["dataset", "subset", "model"]
    wide = spaces.pivot(index=key, columns="target_space", values=["rmse_mm", "mae_mm"])
    wide = wide.reindex(pd.MultiIndex.from_frame(spaces[key].drop_duplicates()))
    of_study = spaces[spaces["is_chosen"]].set_index(key)["target_space"]
    rows = []
    for (dataset, subset, model), errors in wide.iterrows():
        values = [errors[error, space] for error in ("rmse_mm", "mae_mm") for space in SPACES]
        rows.append(
            [
                *(Cell(dataset), Cell(subset, marks.of(dataset, subset)), Cell(titles.models[model])),
                Cell(of_study[dataset, subset, model]),
                *map(number, (*values, values[1] / values[0])),
            ]
        )
    extrapolation = wide.xs(EXTRAPOLATION, level="subset")["rmse_mm"]
    is_better = extrapolation[SPACES[1]] < extrapolation[SPACES[0]]
    sentence = (
        "Every model fitted to positions and to curvature coordinates (bending and length of the arcs from base to "
        "markers), each with the best parameters of its search by outer shells. On extrapolation curvature coordinates "
        f"have the lower RMSE in {is_better.sum()} of {len(is_better)} cases."
    )
    columns = [*filtered_columns("Robot"), SUBSET, *filtered_columns("Model", "Target space of the study")]
    columns += number_columns(
        *(f"{error}, {space} ({marks.unit})" for error in ("RMSE", "MAE") for space in SPACES), "Ratio of RMSE"
    )
    title = "Curvature coordinates beside positions"
    return Grid("spaces", title, sentence, columns, rows, "tables/target_spaces.csv")


def extrapolation_grid(metrics: pd.DataFrame, titles: Titles, level: float, marks: Marks, choices: Choices) -> Grid:
    """One row per run, method and subset at `level`: intervals made for extrapolation beside the oracle's.

    Parameters:
        metrics: as in extrapolation_intervals.csv.
        titles: of models, interval methods and labelled methods.
        level: the nominal level that is shown.
        marks: of datasets and subsets.
        choices: what is chosen and deployed.
    """
    rows = [
        [
            Cell(row.dataset),
            Cell(row.subset, marks.of_interval(row.dataset, row.subset)),
            *map(Cell, (titles.models[row.model], row.preset)),
            Cell(
                titles.methods[row.interval_method],
                choices.of_interval(row.dataset, row.subset, row.model, row.preset, row.interval_method),
            ),
            *(share(row.coverage), share(row.worst_coverage), share(row.joint_coverage)),
            *map(number, (row.mean_width_mm, row.winkler_mm, row.winkler_ratio_to_oracle)),
            Cell(band_text(row.ratio_low, row.ratio_high)),
            number(row.ratio_without_gross),
            Cell(str(row.n_commands) if row.assessable else f"{row.n_commands}: {NOT_ASSESSABLE}"),
            *map(Cell, (row.guarantee, row.labels_used, row.refused if isinstance(row.refused, str) else "")),
        ]
        for row in metrics[metrics["confidence_level"] == level].itertuples()
    ]
    sentence = (
        f"The {share_text(level, 0)} intervals around a few models, means over moving coordinates. Each stands beside "
        "an oracle that is calibrated on the very rows it is scored on and grows with the distance beyond train: a "
        "ratio of 1 is as good as such an interval can be. The band of a ratio holds it in 95 % of draws of the "
        "distinct commands; where these are too few to tell a coverage, it is not assessable. Labels are the positions "
        "of extrapolation rows that a method has looked at. One outer shell is matched to the farthest new command: "
        "intervals made of shells look at all new commands, though at no position, before any is made."
    )
    columns = [*filtered_columns("Robot"), SUBSET, *filtered_columns("Model", "Preset", "Method")]
    columns += number_columns(
        "Coverage", "Worst coordinate", "All at once", "Mean width ({unit})", "Winkler ({unit})", unit=marks.unit
    )
    columns += [*number_columns("Ratio to the oracle's"), Column("Its band")]
    columns += [
        *number_columns("Without gross errors"),
        Column("Distinct commands"),
        Column("Guarantee"),
        Column("Labels used"),
        Column("Refused", is_wide=True),
    ]
    file = "tables/extrapolation_intervals.csv"
    return Grid("extrapolation", "Intervals in extrapolation", sentence, columns, rows, file)
