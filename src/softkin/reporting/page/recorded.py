"""The table of robots in time: scores from session to session."""

from __future__ import annotations

import pandas as pd

from softkin.core.samples import SUBSETS
from softkin.evaluation.recorded_names import BLOCKS, LATER, NEXT_SESSION, PUBLISHED
from softkin.reporting.page.grid import Cell, Grid, filtered_columns, number, number_columns, share
from softkin.reporting.page.marks import Marks
from softkin.reporting.titles import Titles

#: What the splits are called.
SPLITS = {PUBLISHED: "as published", NEXT_SESSION: "next session", LATER: "later"}
SPLITS |= {BLOCKS[name]: f"{title}, part by part" for name, title in SPLITS.items()}


def recorded_grid(recorded: pd.DataFrame, titles: Titles, marks: Marks) -> Grid:
    """One row per robot, split, rows, memory, kind of interval and number of labelled poses."""
    rows = [
        [
            Cell(row.dataset),
            Cell(SPLITS[row.split]),
            Cell(row.subset, marks.of(row.dataset, row.subset) if row.subset in SUBSETS else ()),
            *(Cell(titles.run(row.model, row.preset)), Cell(row.memory), Cell(row.method)),
            Cell(str(row.n_recalibration_poses)),
            *(number(row.rmse_mm), number(row.mae_mm), share(row.coverage)),
            *(number(row.mean_width_mm), number(row.winkler_mm)),
        ]
        for row in recorded.itertuples()
    ]
    sentence = (
        "The deployed run of each robot whose recording order is known, with what it is told of earlier commands and "
        "with the command alone (none): on the published split, whose rows are neighbours in time; fitted on some "
        "sessions and scored on the next; and fitted on the first 80 % in time. Recalibrated means that so many "
        "labelled poses of the new session shifted its zero, drawn 200 times, or its first ones. Part by part, a split "
        "is scored by session and by quarters of its time, so that a mean over all hides none; on the "
        "published split fixed weights fade there with the time to a calibration row."
    )
    shown = [
        *filtered_columns("Robot", "Split", "Rows", "Run", "Memory", "Interval", "Labelled poses"),
        *number_columns("RMSE, {unit}", "MAE, {unit}", "Coverage", "Width, {unit}", "Winkler, {unit}", unit=marks.unit),
    ]
    return Grid("recorded", "In time", sentence, shown, rows, "tables/recorded.csv")
