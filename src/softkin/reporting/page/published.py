"""The paper's printed cells beside ours, with verdicts."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from softkin.core.runs import PRESETS
from softkin.core.samples import TEST
from softkin.reporting.page.grid import NOTHING, Cell, Column, Grid, number
from softkin.reporting.page.marks import Marks
from softkin.reporting.tables.paper_layout import HEADINGS
from softkin.reporting.tables.published_intervals import METRICS

ROBOT, ROWS = Column("Robot", filtered=True), Column("Rows", filtered=True)
METRIC, PRINTED = Column("Metric", filtered=True), Column("Printed", is_number=True)
VERDICT = Column("Verdict", filtered=True)


def best_grid(columns: pd.DataFrame, models: Mapping[str, str], marks: Marks) -> Grid:
    """One row per column of the paper's tables: its best cell against our best tuned model."""
    rows = [
        [
            Cell(row.dataset),
            Cell(row.subset, marks.of(row.dataset, row.subset)),
            Cell(HEADINGS[row.metric]),
            *(Cell(row.printed), Cell(models[row.printed_model])),
            *(number(row.tuned_value), Cell(models[row.tuned_model]), _verdict(row.verdict)),
        ]
        for row in columns.itertuples()
    ]
    sentence = (
        "For each column of the paper's Tables 3 to 5, the best model it prints against the best of ours, tuned; "
        "reproduced means within one unit of the last printed digit."
    )
    shown = [ROBOT, ROWS, METRIC, PRINTED, Column("By"), Column("Ours", is_number=True), Column("By"), VERDICT]
    return Grid("best", "The best of each column", sentence, shown, rows, "tables/published_columns.csv")


def cells_grid(cells: pd.DataFrame, models: Mapping[str, str], marks: Marks) -> Grid:
    """One row per printed cell; value and verdict of each preset that was run."""
    presets = [preset for preset in PRESETS if f"{preset}_value" in cells]
    rows = []
    for row in cells.to_dict("records"):
        ours = [(number(row[f"{preset}_value"]), _verdict(row[f"{preset}_verdict"])) for preset in presets]
        rows.append(
            [
                Cell(row["dataset"]),
                Cell(row["subset"], marks.of(row["dataset"], row["subset"])),
                *(Cell(models[row["model"]]), Cell(HEADINGS[row["metric"]]), Cell(row["printed"])),
                *(cell for pair in ours for cell in pair),
            ]
        )
    sentence = (
        "Every cell of the paper's Tables 3 to 5 beside the same model of ours, with the paper's settings (paper) and "
        "with settings found by cross-validation on the training rows (tuned)."
    )
    shown = [ROBOT, ROWS, Column("Model", filtered=True), METRIC, PRINTED]
    for preset in presets:
        shown += [Column(f"Ours, {preset}", is_number=True), Column(f"Verdict, {preset}", filtered=True)]
    return Grid("cells", "Every printed cell", sentence, shown, rows, "tables/published_comparison.csv")


def intervals_grid(cells: pd.DataFrame, methods: Mapping[str, str], marks: Marks) -> Grid:
    """Two rows per printed dataset and method of Table 6."""
    rows = [
        [
            Cell(row.dataset, marks.of_interval(row.dataset, TEST)),
            *(Cell(methods[row.interval_method]), Cell(METRICS[row.metric]), Cell(row.printed)),
            *(number(row.honest_value), Cell(row.honest_verdict), number(row.nearest_value)),
            *(_verdict(row.nearest_verdict), Cell(row.explanation)),
        ]
        for row in cells.itertuples()
    ]
    sentence = (
        "The paper's Table 6, around gradient boosting with the paper's settings at 90 % on test: printed, our average "
        "over the coordinates that move, and the single coordinate, model and level that comes nearest to the print."
    )
    shown = [ROBOT, Column("Method", filtered=True), METRIC, PRINTED, Column("Ours, average", is_number=True)]
    shown += [Column("Against the print"), Column("Nearest", is_number=True), VERDICT, Column("Remark", is_wide=True)]
    return Grid("published-intervals", "Intervals", sentence, shown, rows, "tables/published_intervals.csv")


def _verdict(word: object) -> Cell:
    """The word as a badge; a preset that was not scored has none."""
    return Cell(word, verdict=word) if isinstance(word, str) and word else Cell(NOTHING)
