"""The table of orientations: angles between predicted and measured rotations, and bounds on them."""

from __future__ import annotations

import pandas as pd

from softkin.reporting.page.grid import Cell, Grid, filtered_columns, number, number_columns, share
from softkin.reporting.page.marks import Marks
from softkin.reporting.titles import Titles


def orientation_grid(scores: pd.DataFrame, titles: Titles, marks: Marks) -> Grid:
    """One row per robot, subset and level."""
    rows = [
        [
            Cell(row.dataset),
            Cell(titles.models[row.model]),
            Cell(row.subset, marks.of(row.dataset, row.subset)),
            *(number(row.mean_deg), number(row.rms_deg), share(row.confidence_level), number(row.bound_deg)),
            *(share(row.coverage), Cell(row.guarantee)),
        ]
        for row in scores.itertuples()
    ]
    sentence = (
        "The orientation of the tip, of each robot whose entry names it: the angle in degrees between the predicted "
        "and the measured rotation, that of train on held-out folds, and an angle that holds it in so many cases, by "
        "split conformal prediction. The model is chosen on train alone, and is none of those of positions."
    )
    shown = [
        *filtered_columns("Robot", "Model", "Rows"),
        *number_columns("Mean, degrees", "RMS, degrees"),
        *filtered_columns("Level"),
        *number_columns("Bound, degrees", "Coverage"),
        *filtered_columns("Promise"),
    ]
    return Grid("orientation", "Orientation", sentence, shown, rows, "tables/orientation.csv")
