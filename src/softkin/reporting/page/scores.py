"""The tables of scores: errors of positions, intervals, and the interval methods each robot could have."""

from __future__ import annotations

from typing import Any

import pandas as pd

from softkin.core.samples import TEST
from softkin.reporting.page.choices import Choices, marks_of_candidate
from softkin.reporting.page.grid import Cell, Column, Grid, filtered_columns, number, number_columns, share
from softkin.reporting.page.interval_rows import interval_rows
from softkin.reporting.page.marks import Marks
from softkin.reporting.page.singles import Singles
from softkin.reporting.tables.interval_choice import RATIO, why_another_is_deployed
from softkin.reporting.tables.numbers import assessed_text, share_text
from softkin.reporting.tables.single_rows import Number
from softkin.reporting.titles import Titles

SUBSET = Column("Rows", filtered=True, preset=TEST)


def point_grid(scores: pd.DataFrame, titles: Titles, marks: Marks, choices: Choices, singles: Singles) -> Grid:
    """One row per robot, subset, model and preset; the deployed run is marked, and numbers that hang on one row."""
    rows = [
        [
            Cell(row.dataset),
            Cell(row.subset, marks.of(row.dataset, row.subset)),
            Cell(titles.models[row.model], choices.of_run(row.dataset, row.model, row.preset)),
            Cell(row.preset),
            *(
                singles.marked(
                    number(getattr(row, metric)), Number(row.dataset, row.subset, row.model, row.preset, metric)
                )
                for metric in ("euclidean_mean_mm", "euclidean_p95_mm", "rmse_mm", "mae_mm", "r2")
            ),
            *map(number, (row.mape_percent, row.fit_seconds, row.predict_us_per_row)),
        ]
        for row in scores.itertuples()
    ]
    sentence = (
        "How far predictions lie from the truth: for a robot, read the mean error, the distance of a marker from its "
        "prediction, and what 95 % of these distances stay below. The other errors are means over coordinates, "
        "constant ones included, as in the paper."
    )
    columns = [*filtered_columns("Robot"), SUBSET, *filtered_columns("Model", "Preset")]
    columns += number_columns(
        "Mean error ({unit})", "95 % below ({unit})", "RMSE ({unit})", "MAE ({unit})", "R2", "MAPE (%)", unit=marks.unit
    )
    columns += number_columns("Fit (s)", "Predict (µs a row)")
    return Grid("points", "Errors of every model", sentence, columns, rows, "tables/point_metrics.csv")


def interval_grid(metrics: pd.DataFrame, titles: Titles, level: float, marks: Marks, choices: Choices) -> Grid:
    """One row per robot, subset, model, preset, method and level; the chosen and the deployed method are marked.

    Parameters:
        metrics: as in interval_metrics.csv.
        titles: of models, interval methods and regions.
        level: the nominal level that is shown at first.
        marks: of datasets and subsets.
        choices: what is chosen and deployed.
    """
    rows = [
        [
            Cell(row.dataset),
            Cell(row.subset, marks.of_interval(row.dataset, row.subset)),
            Cell(
                titles.methods[row.interval_method],
                choices.of_interval(row.dataset, row.subset, row.model, row.preset, row.interval_method),
            ),
            *map(Cell, (titles.models[row.model], row.preset, share_text(row.confidence_level, 0))),
            *(share(row.coverage), Cell(row.as_guaranteed), share(row.joint_coverage)),
            *map(number, (row.mean_width_mm, row.winkler_mm, row.winkler_without_gross_mm, row.size_mm)),
            Cell(row.guarantee),
        ]
        for row in interval_rows(metrics).itertuples()
    ]
    sentence = (
        "How often the interval around a predicted coordinate holds the true one (coverage), how many coordinates are "
        "covered as guaranteed, how often all are at once (joint coverage), and how wide the intervals are. A good "
        "method has a low Winkler score; beside it that without the gross errors that the audit names."
    )
    columns = [*filtered_columns("Robot"), SUBSET, *filtered_columns("Method", "Model", "Preset")]
    columns += [Column("Level", filtered=True, preset=share_text(level, 0)), *number_columns("Coverage")]
    columns += [
        Column("As guaranteed"),
        *number_columns(
            "Joint coverage",
            "Mean width ({unit})",
            "Winkler ({unit})",
            "Without gross errors ({unit})",
            "Size ({unit})",
            unit=marks.unit,
        ),
    ]
    columns += filtered_columns("Guarantee")
    return Grid("intervals", "Intervals of every method", sentence, columns, rows, "tables/interval_metrics.csv")


def choice_grid(choice: pd.DataFrame, titles: Titles, marks: Marks, singles: Singles) -> Grid:
    """One row per robot and candidate; the chosen and the deployed interval are marked, and why they differ is said."""
    rows = [
        [
            Cell(row.dataset, marks.of_interval(row.dataset, TEST)),
            Cell(titles.methods[row.interval_method], marks_of_candidate(row.chosen, row.deployed)),
            Cell(titles.run(row.model, row.preset)),
            *map(number, (row.cv_winkler_typical_mm, row.cv_winkler_mm, row.cv_winkler_without_gross_mm)),
            share(row.test_coverage),
            *map(number, (row.test_mean_width_mm, row.test_winkler_mm, row.test_winkler_without_gross_mm)),
            singles.marked(number(row.winkler_ratio_to_paper), _ratio(row)),
            number(row.winkler_ratio_to_paper_without_gross),
            Cell(titles.methods[row.outside]),
            Cell(assessed_text(row.extrapolation_coverage, row.extrapolation_assessable)),
        ]
        for row in choice.itertuples()
    ]
    sentence = (
        f"The {share_text(choice['confidence_level'].iloc[0], 0)} intervals that each robot could have. The chosen one "
        "has the lowest typical Winkler score (the geometric mean over rows, which a handful of failed rows cannot "
        "turn) when cross-validated on validation rows, the deployed one is the best around the "
        f"deployed model. Their scores on test are in {marks.unit} and as a ratio to the paper's recipe. In "
        "extrapolation, where nothing is guaranteed, another method may take over; a coverage there is not assessable "
        "where distinct commands are too few to tell it."
    )
    columns = [
        *filtered_columns("Robot"),
        Column("Method"),
        Column("Around"),
        *number_columns(
            "Typical Winkler, cross-validated ({unit})",
            "Its mean ({unit})",
            "Mean without gross errors ({unit})",
            unit=marks.unit,
        ),
    ]
    columns += number_columns("Coverage, test", "Mean width, test ({unit})", "Winkler, test ({unit})", unit=marks.unit)
    columns += number_columns(
        "Without gross errors ({unit})", "Ratio to the paper's", "Ratio without gross errors", unit=marks.unit
    )
    columns += [Column("In extrapolation"), *number_columns("Coverage there")]
    reasons = [f"{dataset}: {why}" for dataset, why in why_another_is_deployed(choice, titles).items()]
    file = "tables/interval_choice.csv"
    return Grid("choice", "Chosen and deployed intervals", sentence, columns, rows, file, reasons)


def _ratio(row: Any) -> Number:
    """Key of the ratio of a row of interval_choice."""
    return Number(row.dataset, TEST, row.model, row.preset, RATIO, row.interval_method)
