"""The tables of scores: positions, intervals, and which interval each robot got."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from softkin.core.samples import TEST
from softkin.reporting.page.grid import NOTHING, Cell, Column, Grid, number, number_text, share, share_text
from softkin.reporting.page.marks import CHOSEN, Marks
from softkin.training.selection import deployed
from softkin.uncertainty.intervals.spec import MARGINAL

ROBOT, SUBSET = Column("Robot", filtered=True), Column("Rows", filtered=True, preset=TEST)
MODEL, PRESET = Column("Model", filtered=True), Column("Preset", filtered=True)
METHOD, COVERS = Column("Method", filtered=True), Column("Covers", is_number=True)
RUN = ["dataset", "subset", "model", "preset", "interval_method", "confidence_level"]


def point_grid(scores: pd.DataFrame, selection: pd.DataFrame | None, models: Mapping[str, str], marks: Marks) -> Grid:
    """One row per robot, subset, model and preset; the chosen model is marked."""
    key = ["dataset", "model", "preset"]
    chosen = set() if selection is None else set(deployed(selection)[key].itertuples(index=False, name=None))
    rows = [
        [
            Cell(row.dataset),
            Cell(row.subset, marks.of(row.dataset, row.subset)),
            Cell(models[row.model], (CHOSEN,) * ((row.dataset, row.model, row.preset) in chosen)),
            Cell(row.preset),
            *map(number, (row.euclidean_mean_mm, row.euclidean_p95_mm, row.rmse_mm, row.mae_mm, row.r2)),
            *map(number, (row.mape_percent, row.fit_seconds, row.predict_us_per_row)),
        ]
        for row in scores.itertuples()
    ]
    sentence = (
        "How far predictions lie from the truth: for a robot, read the mean error, the distance of a marker from its "
        "prediction, and what 95 % of these distances stay below; the other errors are means over coordinates, as in "
        "the paper, those that never move included."
    )
    measured = ["Mean error (mm)", "95 % below (mm)", "RMSE (mm)", "MAE (mm)", "R2", "MAPE (%)"]
    measured += ["Fit (s)", "Predict (µs a row)"]
    columns = [ROBOT, SUBSET, MODEL, PRESET, *(Column(title, is_number=True) for title in measured)]
    return Grid("points", "Errors of every model", sentence, columns, rows, "tables/point_metrics.csv")


def interval_grid(
    metrics: pd.DataFrame, models: Mapping[str, str], methods: Mapping[str, str], level: float, marks: Marks
) -> Grid:
    """One row per robot, subset, model, preset, method and level; `level` is shown at first."""
    rows = [
        [
            Cell(row.dataset),
            Cell(row.subset, marks.of_interval(row.dataset, row.subset)),
            Cell(methods[row.interval_method]),
            Cell(models[row.model]),
            Cell(row.preset),
            Cell(share_text(row.confidence_level, digits=0)),
            *(share(row.coverage), Cell(row.as_promised), share(row.joint_coverage)),
            *map(number, (row.mean_width_mm, row.winkler_mm, row.size_mm)),
            Cell(row.guarantee),
        ]
        for row in interval_rows(metrics).itertuples()
    ]
    sentence = (
        "How often the interval around a predicted coordinate holds the true one, how many coordinates do so as often "
        "as promised, how often all do at once, and how wide the intervals are; a good one has a low Winkler score."
    )
    columns = [
        ROBOT,
        SUBSET,
        METHOD,
        MODEL,
        PRESET,
        Column("Level", filtered=True, preset=share_text(level, digits=0)),
        COVERS,
    ]
    columns += [Column("As promised"), Column("At once", is_number=True), Column("Mean width (mm)", is_number=True)]
    columns += [Column("Winkler (mm)", is_number=True), Column("Size (mm)", is_number=True)]
    columns += [Column("Promises", filtered=True)]
    return Grid("intervals", "Intervals of every method", sentence, columns, rows, "tables/interval_metrics.csv")


def interval_rows(metrics: pd.DataFrame) -> pd.DataFrame:
    """Per run, subset, method and level: the mean over moving coordinates (absent of a region), the joint coverage and
    size, the promise, and `as_promised`: how many coordinates, or whether all at once, keep it.
    """
    keyed = metrics.set_index(RUN)
    mean = keyed[keyed["coordinate"] == "mean_informative"][["coverage", "mean_width_mm", "winkler_mm", "guarantee"]]
    joint = keyed[keyed["coordinate"] == "joint"]
    wide = joint[["coverage", "size_mm"]].rename(columns={"coverage": "joint_coverage"}).join(mean)
    wide["guarantee"] = wide["guarantee"].fillna(joint["guarantee"])
    wide["as_promised"] = _as_promised(keyed[keyed["guarantee"] == MARGINAL]).reindex(wide.index)
    exact = joint[joint["guarantee"] == "joint"]
    inside = exact["coverage"].between(exact["coverage_low"] - 1e-9, exact["coverage_high"] + 1e-9)
    wide["as_promised"] = wide["as_promised"].fillna(inside.map({True: "yes", False: "no"}).reindex(wide.index))
    return wide.fillna({"as_promised": NOTHING}).reset_index()


def _as_promised(marginal: pd.DataFrame) -> pd.Series:
    """'17 of 18' moving coordinates in their band, per run; one that never moves has no corrected p-value."""
    banded = marginal[marginal["coverage_p_value_holm"].notna()]
    inside = banded["coverage"].between(banded["coverage_low"] - 1e-9, banded["coverage_high"] + 1e-9)
    counts = inside.groupby(level=RUN).agg(["sum", "size"]).astype(str)
    return counts["sum"] + " of " + counts["size"]


def choice_grid(choice: pd.DataFrame, models: Mapping[str, str], methods: Mapping[str, str], marks: Marks) -> Grid:
    """One row per robot and candidate; the chosen interval is marked."""
    rows = [
        [
            Cell(row.dataset, marks.of_interval(row.dataset, TEST)),
            Cell(methods[row.interval_method], (CHOSEN,) * bool(row.chosen)),
            Cell(f"{models[row.model]}, {row.preset}"),
            number(row.cv_winkler_mm),
            share(row.test_coverage),
            *map(number, (row.test_mean_width_mm, row.test_winkler_mm)),
            Cell(number_text(row.winkler_ratio_to_paper)),
            Cell(methods[row.outside]),
            share(row.extrapolation_coverage),
        ]
        for row in choice.itertuples()
    ]
    level = choice["confidence_level"].iloc[0]
    sentence = (
        f"The {share_text(level, digits=0)} intervals that each robot could have had, and the one it got, that of the "
        "lowest Winkler score on validation rows; what it was worth shows on test rows, in mm and as a ratio to the "
        "paper's recipe. Beyond the training range, where nothing is promised, another method may take over."
    )
    columns = [ROBOT, Column("Method"), Column("Around"), Column("Winkler when choosing (mm)", is_number=True)]
    columns += [Column("Covers, test", is_number=True), Column("Mean width, test (mm)", is_number=True)]
    columns += [Column("Winkler, test (mm)", is_number=True), Column("Ratio to the paper's", is_number=True)]
    columns += [Column("Beyond the range"), Column("Covers there", is_number=True)]
    return Grid("choice", "Which interval each robot got", sentence, columns, rows, "tables/interval_choice.csv")
