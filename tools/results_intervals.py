"""Sections of the results page on intervals; each function returns names -> tables, counts, texts of numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd

from softkin.core.metrics.interval import fewest_commands
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.evaluation.beside_oracle import BAND
from softkin.models.spec import PAPERS_RUN
from softkin.reporting.tables.interval_choice import PAPERS_METHOD
from softkin.reporting.tables.numbers import NOT_ASSESSABLE, NOTHING, band_text, number_text, share_text
from softkin.reporting.tables.published_intervals import AVERAGES
from softkin.reporting.tables.single_rows import Number
from softkin.uncertainty.labelled import LABELLED_METHODS
from softkin.uncertainty.regions import REGION_METHODS
from softkin.uncertainty.regions.spec import JOINT_INTERVALS
from tools.finished_run import TITLES, FinishedRun, table
from tools.run_tables import ONE_FOR_EVERYWHERE, RUN

RATIOS = ("winkler_ratio_to_paper", "winkler_ratio_to_paper_without_gross")
ORACLE, RATIO = "oracle", "winkler_ratio_to_oracle"


def intervals_in_domain(run: FinishedRun) -> dict[str, Any]:
    """What intervals hold on `test`, where something is promised."""
    n_coordinates, n_in_band = _in_band(run)
    return {
        "level": share_text(run.tables.level, 0),
        "intervals": _chosen(run),
        "n_coordinates": n_coordinates,
        "n_in_band": n_in_band,
        "papers_methods": _coverage(run, run.tables.papers_intervals()),
        "gaussian_process": _coverage(run, run.tables.gaussian_process_intervals()),
        "joint": _joint(run),
        "alarms": _alarms(run),
    }


def _chosen(run: FinishedRun) -> str:
    """Per robot the paper's recipe, the chosen and the deployed method."""
    means = run.tables.interval_means().set_index([*RUN, "interval_method", "subset"])
    choice = run.tables.chosen_intervals()
    rows = []
    scored = ("coverage", "winkler_mm", "winkler_without_gross_mm")
    for dataset in run.datasets:
        shown = choice[choice["dataset"] == dataset].to_dict("records")
        recipe = (dataset, *PAPERS_RUN, PAPERS_METHOD, TEST)
        if recipe in means.index:
            scores = {f"test_{name}": means.loc[recipe, name] for name in scored}
            papers = dict(zip([*RUN, "interval_method"], recipe, strict=False))
            shown.insert(0, papers | scores | dict.fromkeys(RATIOS, 1.0))
        for row in shown:
            key = Number(dataset, TEST, row["model"], row["preset"], "winkler_mm", row["interval_method"])
            role = " and ".join(name for name in ("chosen", "deployed") if row.get(name)) or "the paper's recipe"
            rows.append(
                [
                    *(run.name(dataset, TEST), role, TITLES.methods[row["interval_method"]]),
                    TITLES.run(row["model"], row["preset"]),
                    *(share_text(row["test_coverage"]), run.starred(row["test_winkler_mm"], key)),
                    number_text(row["test_winkler_without_gross_mm"]),
                    *(run.starred(row[name], key._replace(metric=name)) for name in RATIOS),
                ]
            )
    header = ["Robot", "Interval", "Method", "Around", "Coverage", "Winkler score (mm)"]
    header += ["Without gross errors (mm)", "Of the recipe's", "Without gross errors"]
    return table(header, rows)


def _in_band(run: FinishedRun) -> tuple[int, int]:
    """Of the deployed intervals on `test`: moving coordinates, and those whose coverage lies in its exact band."""
    choice = run.tables.chosen_intervals()
    metrics = run.tables.at_level("interval_metrics")
    single = metrics[~metrics["coordinate"].isin(AVERAGES) & (metrics["subset"] == TEST)]
    key = [*RUN, "interval_method"]
    of_deployed = single.merge(choice.loc[choice["deployed"], key], on=key)
    constant = {name: run.description(name)["constant_coordinates"] for name in run.datasets}
    pairs = zip(of_deployed["dataset"], of_deployed["coordinate"], strict=True)
    moving = of_deployed[[coordinate not in constant[dataset] for dataset, coordinate in pairs]]
    in_band = moving["coverage"].between(moving["coverage_low"], moving["coverage_high"])
    return len(moving), int(in_band.sum())


def _coverage(run: FinishedRun, scores: pd.DataFrame) -> str:
    """Coverage of each method on test and in extrapolation, a row per dataset."""
    methods = list(dict.fromkeys(scores.index.get_level_values("interval_method")))
    columns = [(subset, name) for name in methods for subset in (TEST, EXTRAPOLATION)]
    coverage = scores["coverage"].to_dict()
    rows = [
        [run.name(dataset, TEST), *(share_text(coverage.get((dataset, *column))) for column in columns)]
        for dataset in run.datasets
    ]
    return table(["Robot", *(f"{TITLES.methods[name]}, {subset}" for subset, name in columns)], rows)


def _joint(run: FinishedRun) -> str:
    """How often a whole pose is held: by the deployed intervals of single coordinates, and by joint regions."""
    choice = run.tables.chosen_intervals()
    single = choice[choice["deployed"]].set_index("dataset")["interval_method"].to_dict()
    rows = [
        [
            *(run.name(row["dataset"], TEST), TITLES.methods[row["interval_method"]]),
            *(share_text(row["coverage"]), number_text(row["size_mm"])),
        ]
        for row in run.tables.joint_coverage().to_dict("records")
        if row["interval_method"] in (*REGION_METHODS, JOINT_INTERVALS, single.get(row["dataset"]))
    ]
    return table(["Robot", "Region", "Holds the whole pose", "Edge of a cube of its volume (mm)"], rows)


def _alarms(run: FinishedRun) -> str:
    """How many poses raise an alarm, as they are and displaced."""
    rows = [
        [
            *(run.name(row["dataset"], TEST), str(row["n_rows"]), number_text(row["displacement_mm"])),
            share_text(row["joint_alarm_rate"]),
            f"{share_text(row['joint_low'])} to {share_text(row['joint_high'])}",
        ]
        for row in run.tables.alarms().to_dict("records")
    ]
    return table(["Robot", "Poses", "Displaced by (mm)", "Alarms", "Exact band"], rows)


def intervals_in_extrapolation(run: FinishedRun) -> dict[str, Any]:
    """What intervals hold in extrapolation, beside the oracle."""
    frame = run.tables.at_level("extrapolation_intervals")
    frame = frame[frame["subset"] == EXTRAPOLATION]
    deployed = run.tables.deployed()[RUN]
    return {
        "band": share_text(BAND, 0),
        "fewest": str(fewest_commands(run.tables.level)),
        "one_for_everywhere": _plain_and_widened(run, frame, deployed),
        "labelled": _labelled(run, frame.merge(deployed, on=RUN)),
    }


def _plain_and_widened(run: FinishedRun, frame: pd.DataFrame, deployed: pd.DataFrame) -> str:
    """The interval for everywhere and plain split conformal prediction, around each model that is listed for a robot:
    all robots are, and where the models of `auto` were not refitted there is a dash.
    """
    scores = frame.set_index([*RUN, "interval_method"]).to_dict("index")
    means = run.tables.interval_means()
    plain = means[(means["subset"] == EXTRAPOLATION) & (means["interval_method"] == PAPERS_METHOD)]
    plain_coverage = plain.set_index(RUN)["coverage"].to_dict()
    own = set(deployed.itertuples(index=False, name=None))
    rows = []
    for around in frame[["model", "preset"]].drop_duplicates().itertuples(index=False, name=None):
        for dataset in run.datasets:
            of = scores.get((dataset, *around, ONE_FOR_EVERYWHERE), {})
            of_plain = scores.get((dataset, *around, PAPERS_METHOD), {})
            deployed_here = ", deployed" if (dataset, *around) in own else ""
            shares = [share_text(of.get(name)) for name in ("coverage", "worst_coverage", "joint_coverage")]
            rows.append(
                [
                    *(run.name(dataset, EXTRAPOLATION), TITLES.run(*around) + deployed_here, *shares),
                    *(_ratio(of), number_text(of.get("ratio_without_gross"))),
                    *(share_text(plain_coverage.get((dataset, *around))), _ratio(of_plain)),
                ]
            )
    header = ["Robot", "Around", "Coverage", "Worst coordinate", "Whole pose", "Ratio (band)", "Without gross errors"]
    return table([*header, f"{TITLES.methods[PAPERS_METHOD]}: coverage", "Its ratio (band)"], rows)


def _ratio(scores: Mapping[str, Any]) -> str:
    """The ratio to the oracle's score with its band, or that the commands are too few to tell a coverage."""
    if not scores:
        return NOTHING
    if not scores["assessable"]:
        return f"{NOT_ASSESSABLE}: {scores['n_commands']} commands"
    return f"{number_text(scores[RATIO])} ({band_text(scores['ratio_low'], scores['ratio_high'])})"


def _labelled(run: FinishedRun, frame: pd.DataFrame) -> str:
    """The labelled methods around the deployed models: scores, labels used, and how much weight is left."""
    rows = []
    for row in frame[frame["interval_method"].isin(list(LABELLED_METHODS))].to_dict("records"):
        if row["interval_method"] == ORACLE or not row["assessable"]:
            continue
        coverage = "refuses" if isinstance(row["refused"], str) else share_text(row["coverage"])
        numbers = [number_text(row[name]) for name in (RATIO, "domain_auc", "effective_size")]
        method = [run.name(row["dataset"], EXTRAPOLATION), TITLES.methods[row["interval_method"]], row["labels_used"]]
        rows.append([*method, coverage, share_text(row["infinite_share"]), *numbers])
    header = ["Robot", "Method", "Labels used", "Coverage", "Infinite", "Ratio", "AUC", "Calibration rows left"]
    return table(header, rows)
