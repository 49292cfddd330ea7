"""What holds outside `train`: how well scores on `train` foretold errors there, and which intervals hold."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.reporting.page.grid import Cell, Column, Grid, number, number_text, share, share_text
from softkin.reporting.page.marks import Marks

#: What is compared with what.
SPACES = ("cartesian", "curvature")
ROBOT, MODEL, PRESET = (Column(title, filtered=True) for title in ("Robot", "Model", "Preset"))


def searched_grid(runs: pd.DataFrame, models: Mapping[str, str], marks: Marks) -> Grid:
    """One row per searched run: its scores on train, its errors, and the target space it was given."""
    rows = [
        [
            Cell(row.dataset, marks.of(row.dataset, TEST)),
            *map(Cell, (models[row.model], row.preset, row.target_space)),
            *map(number, (row.cv_mae_mm, row.shell_mae_mm, row.test_mae_mm, row.extrapolation_mae_mm)),
        ]
        for row in runs.itertuples()
    ]
    correlations = [
        f"{dataset} {number_text(one['shell_rank_correlation'])} ({number_text(one['cv_rank_correlation'])})"
        for dataset, one in runs.groupby("dataset", sort=False).first().iterrows()
    ]
    sentence = (
        "Models are chosen by two scores on train alone: cross-validation, for commands like those of train, and outer "
        "shells of train, for commands beyond it. How well the shells foretold the order of the runs on extrapolation "
        "rows (Spearman's rank correlation; that of cross-validation in brackets): " + ", ".join(correlations) + "."
    )
    columns = [ROBOT, MODEL, PRESET, Column("Fitted to", filtered=True)]
    titles = ["Cross-validation (mm)", "Outer shells (mm)", "MAE, test (mm)", "MAE, extrapolation (mm)"]
    columns += [Column(title, is_number=True) for title in titles]
    return Grid("searched", "What scores on train foretold", sentence, columns, rows, "tables/searched_runs.csv")


def spaces_grid(spaces: pd.DataFrame, models: Mapping[str, str], marks: Marks) -> Grid:
    """One row per model and subset: its errors in curvature coordinates beside those in positions."""
    key = ["dataset", "subset", "model"]
    wide = spaces.pivot(index=key, columns="target_space", values=["rmse_mm", "mae_mm"])
    wide = wide.reindex(pd.MultiIndex.from_frame(spaces[key].drop_duplicates()))
    chosen = spaces[spaces["is_chosen"]].set_index(key)["target_space"]
    rows = []
    for (dataset, subset, model), errors in wide.iterrows():
        mine = [errors[error, space] for error in ("rmse_mm", "mae_mm") for space in SPACES]
        rows.append(
            [
                Cell(dataset),
                Cell(subset, marks.of(dataset, subset)),
                Cell(models[model]),
                Cell(chosen[dataset, subset, model]),
                *map(number, mine),
                Cell(number_text(mine[1] / mine[0])),
            ]
        )
    beyond = wide.xs(EXTRAPOLATION, level="subset")["rmse_mm"]
    better = beyond[SPACES[1]] < beyond[SPACES[0]]
    sentence = (
        "Every model fitted to positions and to curvature coordinates (bending and length of the arcs from base to "
        "markers), each with the best parameters of its search by outer shells. On extrapolation curvature coordinates "
        f"have the lower RMSE in {better.sum()} of {len(better)} cases."
    )
    columns = [ROBOT, Column("Rows", filtered=True, preset=EXTRAPOLATION), MODEL, Column("Chosen", filtered=True)]
    titles = [f"{error}, {space} (mm)" for error in ("RMSE", "MAE") for space in SPACES]
    columns += [Column(title, is_number=True) for title in [*titles, "Ratio of RMSE"]]
    return Grid("spaces", "What curvature coordinates are worth", sentence, columns, rows, "tables/target_spaces.csv")


def outside_grid(
    metrics: pd.DataFrame, models: Mapping[str, str], methods: Mapping[str, str], level: float, marks: Marks
) -> Grid:
    """One row per run, method and subset at `level`: intervals for commands outside train beside the oracle's."""
    shown = metrics[metrics["confidence_level"] == level]
    rows = [
        [
            Cell(row.dataset),
            Cell(row.subset, marks.of_interval(row.dataset, row.subset)),
            *map(Cell, (models[row.model], row.preset, methods[row.interval_method])),
            share(row.coverage),
            *map(number, (row.mean_width_mm, row.winkler_mm, row.winkler_ratio_to_oracle)),
            *map(Cell, (row.guarantee, row.labels_used, row.refused if isinstance(row.refused, str) else "")),
        ]
        for row in shown.itertuples()
    ]
    sentence = (
        f"The {share_text(level, digits=0)} intervals around a few models, means over moving coordinates. Each "
        "stands beside an oracle that is calibrated on the very rows it is scored on: a ratio of 1 is as good as an "
        "interval of constant width can be. Labels are the positions of extrapolation rows that a method has looked at."
    )
    columns = [
        ROBOT,
        Column("Rows", filtered=True, preset=EXTRAPOLATION),
        MODEL,
        PRESET,
        Column("Method", filtered=True),
    ]
    titles = ["Covers", "Mean width (mm)", "Winkler (mm)", "Ratio to the oracle's"]
    columns += [Column(title, is_number=True) for title in titles]
    columns += [Column("Promised"), Column("Labels used"), Column("Refused", is_wide=True)]
    file = "tables/extrapolation_intervals.csv"
    return Grid("outside", "Intervals outside the training shell", sentence, columns, rows, file)
