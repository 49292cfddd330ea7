"""The tables of the paper's printed cells beside ours, with verdicts."""

from __future__ import annotations

import pandas as pd

from softkin.core.runs import PRESETS
from softkin.core.samples import TEST
from softkin.reporting.page.grid import Cell, Column, Grid, filtered_columns, number, number_columns
from softkin.reporting.page.marks import Marks
from softkin.reporting.tables.numbers import NOTHING, number_text, share_text
from softkin.reporting.tables.paper_layout import HEADINGS
from softkin.reporting.tables.published_intervals import METRICS
from softkin.reporting.titles import Titles


def best_grid(columns: pd.DataFrame, titles: Titles, marks: Marks) -> Grid:
    """One row per column of the paper's tables: its best cell against our best tuned model."""
    rows = [
        [
            Cell(row.dataset),
            Cell(row.subset, marks.of(row.dataset, row.subset)),
            Cell(HEADINGS[row.metric]),
            *(Cell(row.printed), Cell(titles.models[row.printed_model])),
            *(number(row.tuned_value), Cell(titles.models[row.tuned_model]), _verdict(row.verdict)),
        ]
        for row in columns.itertuples()
    ]
    sentence = (
        "For each column of the paper's Tables 3 to 5, the best model it prints against the best of ours, tuned; "
        "reproduced means within one unit of the last printed digit."
    )
    shown = [
        *filtered_columns("Robot", "Rows", "Metric"),
        *number_columns("Printed"),
        Column("By"),
        *number_columns("Ours"),
        Column("By"),
    ]
    shown += filtered_columns("Verdict")
    return Grid("best", "The best of each column", sentence, shown, rows, "tables/published_columns.csv")


def cells_grid(cells: pd.DataFrame, titles: Titles, marks: Marks) -> Grid:
    """One row per printed cell; value and verdict of each preset that was run."""
    presets = [preset for preset in PRESETS if f"{preset}_value" in cells]
    rows = []
    for row in cells.to_dict("records"):
        ours = [(number(row[f"{preset}_value"]), _verdict(row[f"{preset}_verdict"])) for preset in presets]
        rows.append(
            [
                Cell(row["dataset"]),
                Cell(row["subset"], marks.of(row["dataset"], row["subset"])),
                *(Cell(titles.models[row["model"]]), Cell(HEADINGS[row["metric"]]), Cell(row["printed"])),
                *(cell for pair in ours for cell in pair),
            ]
        )
    sentence = (
        "Every cell of the paper's Tables 3 to 5 beside the same model of ours, with the settings of a preset: those "
        "of the paper (paper), and those that a search on train found, by cross-validation (tuned) or by outer shells "
        "(outer)."
    )
    shown = [*filtered_columns("Robot", "Rows", "Model", "Metric"), *number_columns("Printed")]
    for preset in presets:
        shown += [*number_columns(f"Ours, {preset}"), *filtered_columns(f"Verdict, {preset}")]
    return Grid("cells", "Every printed cell", sentence, shown, rows, "tables/published_comparison.csv")


def intervals_grid(cells: pd.DataFrame, titles: Titles, marks: Marks) -> Grid:
    """Two rows per printed dataset and method of Table 6; the badge is that of the average."""
    rows = [
        [
            Cell(row.dataset, marks.of_interval(row.dataset, TEST)),
            *(Cell(titles.methods[row.interval_method]), Cell(METRICS[row.metric]), Cell(row.printed)),
            *(number(row.honest_value), _verdict(row.honest_verdict)),
        ]
        for row in cells.itertuples()
    ]
    sentence = (
        "The paper's Table 6, around gradient boosting with the paper's settings at 90 % on test: printed beside our "
        "average over the moving coordinates. The CSV says where a printed score is too low for an average."
    )
    shown = [
        *filtered_columns("Robot", "Method", "Metric"),
        *number_columns("Printed", "Ours, average"),
        *filtered_columns("Verdict"),
    ]
    remarks = _nearest(cells, titles)
    return Grid("published-intervals", "Intervals", sentence, shown, rows, "tables/published_intervals.csv", remarks)


def _nearest(cells: pd.DataFrame, titles: Titles) -> list[str]:
    """What comes nearest to each pair of printed cells, and how free the search was that found it."""
    remarks = [
        "Nearest settings, which decide nothing: for each pair of printed cells the single coordinate, run, method of "
        "the same package and level whose two scores come nearest. Of so many combinations some come near any print."
    ]
    for key, pair in cells.groupby(["dataset", "interval_method"], sort=False):
        row, (dataset, printed) = pair.iloc[0], key
        method = titles.methods[row["nearest_interval_method"]]
        run, level = titles.run(row["nearest_model"], row["nearest_preset"]), row["nearest_confidence_level"]
        scores = " and ".join(
            f"{number_text(cell.nearest_value)} (printed {cell.printed})" for cell in pair.itertuples()
        )
        remarks.append(
            f"{dataset}, {titles.methods[str(printed)]}: of {row['nearest_of']} combinations "
            f"{row['nearest_coordinate']}, {method} around {run} at {share_text(level, 0)}: {scores}."
        )
    return remarks


def _verdict(word: object) -> Cell:
    """The word as a badge; a preset that was not scored has none."""
    return Cell(word, verdict=word) if isinstance(word, str) and word else Cell(NOTHING)
