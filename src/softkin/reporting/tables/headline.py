"""Write the headline of a run: per dataset the deployed model, its errors and intervals, and the counts of verdicts."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from softkin.core.escaping import one_line
from softkin.core.metrics.interval import fewest_commands
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.data.audit.findings import LEAK, NOTE
from softkin.reporting.tables.interval_choice import chosen_intervals, deployed_intervals
from softkin.reporting.tables.joint_intervals import joint_scores
from softkin.reporting.tables.numbers import NOT_ASSESSABLE, assessed_text, number_text, share_text
from softkin.reporting.tables.single_rows import Hanging, Number, hanging, of_runs
from softkin.reporting.units import heading_of, told, units_in
from softkin.uncertainty.intervals.spec import AUTO

WIDTH = 90
AIMS = {
    "interpolation": "commands like those of train",
    "extrapolation": "commands beyond those of train",
    "both": "commands like those of train and beyond",
}
#: Findings that are told in full, of each dataset; its data card has them all.
MOST_FINDINGS = 4


def headline(
    selected: pd.DataFrame | None,
    point: pd.DataFrame,
    choice: pd.DataFrame,
    sentences: Sequence[str],
    findings: Mapping[str, Sequence[Mapping[str, Any]]] | None = None,
    caution: str | None = None,
    metrics: pd.DataFrame | None = None,
    left_out: pd.DataFrame | None = None,
) -> str:
    """Plain text of at most `WIDTH` columns.

    Parameters:
        selected: the deployed run of each dataset; None where nothing was searched.
        point: as in point_metrics.csv.
        choice: as in interval_choice.csv.
        sentences: what else there is to say: of orientations, and how the paper's cells compare with ours.
        findings: of the audit of each dataset, as data_card.json has them; none by default.
        caution: what the configuration says of its own numbers.
        metrics: as in interval_metrics.csv; None: nothing is said of whole poses.
        left_out: as in left_out.csv; None: no number is marked that hangs on a single row.
    """
    width = 2 + max(18, *map(len, choice["dataset"]))
    unit, units = heading_of(choice), units_in(choice)
    lines = ["", f"softkin: forward kinematics, mean error of a marker position ({unit})", ""]
    if others := told(units):
        lines += [*(f"  {dataset}: all lengths are {said}." for dataset, said in others.items()), ""]
    if caution:
        lines += [
            *textwrap.wrap(f"CAUTION: {one_line(caution)}", WIDTH, initial_indent="  ", subsequent_indent="  "),
            "",
        ]
    if selected is not None:
        lines += _errors(selected, point, {} if left_out is None else hanging(left_out), width)
    lines += _intervals(choice, width)
    if metrics is not None:
        lines += _whole_poses(joint_scores(metrics, deployed_intervals(choice)), choice, width)
    lines += _findings(findings or {})
    lines += [f"  {sentence}" for sentence in sentences]
    return "\n".join([*lines, ""])


def _errors(selected: pd.DataFrame, point: pd.DataFrame, found: Mapping[Number, Hanging], width: int) -> list[str]:
    """Lines on the errors of the deployed models; a mean that hangs on a single row is marked."""
    marked = of_runs(found, selected, "euclidean_mean_mm")
    lines = [f"  {'dataset':<{width}}{'model':<16}{'test':>13}{'95 % below':>13}{'extrapolation':>15}"]
    remarks = []
    scores = point.set_index(["dataset", "model", "preset", "subset"])
    for row in selected.itertuples():
        test, extrapolation = (
            scores.loc[(row.dataset, row.model, row.preset, subset)] for subset in (TEST, EXTRAPOLATION)
        )
        mean, p95 = test["euclidean_mean_mm"], test["euclidean_p95_mm"]
        model = f"{row.model} {row.preset}"
        inside, beyond = (
            number_text(value) + "*" * ((row.dataset, subset) in marked)
            for value, subset in ((mean, TEST), (extrapolation["euclidean_mean_mm"], EXTRAPOLATION))
        )
        lines.append(f"  {row.dataset:<{width}}{model:<16}{inside:>13}{number_text(p95):>13}{beyond:>15}")
        if mean > p95:
            remarks.append(f"  {row.dataset}: a few gross errors set the mean, which exceeds the 95th percentile.")
    aim = AIMS[selected["objective"].iloc[0]]
    remarks += [f"  * {dataset}, {subset}: {what.text}." for (dataset, subset), what in marked.items()]
    return [*lines, "", f"  The model is chosen for {aim}, on `train` alone.", *remarks]


def _intervals(choice: pd.DataFrame, width: int) -> list[str]:
    """Lines on the interval of each calibrated model: method, mean width, coverage on test and on extrapolation."""
    deployed = deployed_intervals(choice)
    level = share_text(deployed["confidence_level"].iloc[0], 0)
    lines = ["", f"  {level} intervals of the calibrated models, mean over moving coordinates", ""]
    columns = f"{'around':<16}{'method':<14}{_sized('width', choice):>13}{'test':>9}{'extrapolation':>15}"
    lines.append(f"  {'dataset':<{width}}{columns}")
    for row in deployed.itertuples():
        run, size = f"{row.model} {row.preset}", number_text(row.test_mean_width_mm)
        beyond = assessed_text(row.extrapolation_coverage, row.extrapolation_assessable)
        shares = f"{share_text(row.test_coverage):>9}{beyond:>15}"
        lines.append(f"  {row.dataset:<{width}}{run:<16}{row.interval_method:<14}{size:>13}{shares}")
    return [*lines, "", *_claims(choice, deployed), *_not_assessable(deployed), *_not_deployed(choice), ""]


def _sized(what: str, choice: pd.DataFrame) -> str:
    """What a column holds, with its unit where all datasets have one: 'width (mm)'."""
    units = set(units_in(choice).values())
    return f"{what} ({units.pop()})" if len(units) == 1 else what


def _not_assessable(deployed: pd.DataFrame) -> list[str]:
    """Lines on robots whose extrapolation has too few distinct commands to tell a coverage."""
    lines = []
    for row in deployed[~deployed["extrapolation_assessable"]].itertuples():
        level, fewest = share_text(row.confidence_level, 0), fewest_commands(row.confidence_level)
        lines += _wrapped(
            f"  {row.dataset}: extrapolation has {row.extrapolation_commands} distinct commands, and {fewest} are the "
            f"fewest that can tell a coverage of {level}: {NOT_ASSESSABLE}."
        )
    return lines


def _whole_poses(scores: pd.DataFrame, choice: pd.DataFrame, width: int) -> list[str]:
    """Lines on the joint intervals of each calibrated model: shape, size, and how often they hold a whole pose."""
    if scores.empty:
        return []
    level = share_text(choice["confidence_level"].iloc[0], 0)
    lines = [f"  {level} joint intervals of the calibrated models, which hold all moving coordinates at once", ""]
    size = _sized("size", choice)
    lines.append(f"  {'dataset':<{width}}{'shape':<16}{'':<14}{size:>13}{'test':>9}{'extrapolation':>15}")
    for row in scores.itertuples():
        shares = f"{share_text(row.test):>9}{assessed_text(row.extrapolation, row.assessable):>15}"
        lines.append(f"  {row.Index:<{width}}{row.shape:<16}{'':<14}{number_text(row.size_mm):>13}{shares}")
    least, most = (share_text(share, 0) for share in (scores["single_test"].min(), scores["single_test"].max()))
    held = least if least == most else f"{least} to {most}"
    said = f"  Intervals of single coordinates hold a whole pose of test in {held} of cases."
    return [*lines, "", *_wrapped(said), ""]


def _claims(choice: pd.DataFrame, deployed: pd.DataFrame) -> list[str]:
    """Lines on what these intervals are, as far as it is so in this run."""
    had_a_choice = (choice["dataset"].value_counts() > 1).all()
    if had_a_choice and deployed["deployed"].all():
        lines = ["  The method is the best around that model, chosen and calibrated on `validation`."]
    else:
        lines = ["  The method is calibrated on `validation`."]
    widened = deployed.loc[deployed["outside"] == AUTO, "dataset"]
    beyond = "  In extrapolation nothing is guaranteed"
    if widened.empty:
        return [*lines, f"{beyond}."]
    if len(widened) == len(deployed):
        return [*lines, f"{beyond}; outer shells of `train` widen intervals."]
    return [*lines, *_wrapped(f"{beyond}; outer shells of `train` widen intervals of {', '.join(widened)}.")]


def _findings(findings: Mapping[str, Sequence[Mapping[str, Any]]]) -> list[str]:
    """Lines on what the audit found: leaks and warnings in full, as many as are told, and how many more there are."""
    lines = []
    for dataset, found in findings.items():
        grave = sorted((one for one in found if one["severity"] != NOTE), key=lambda one: one["severity"] != LEAK)
        told = grave[:MOST_FINDINGS]
        for one in told:
            word = "LEAK" if one["severity"] == LEAK else one["severity"]
            lines += _wrapped(f"  {dataset}: {word}. {one_line(one['sentence'])}")
        left = len(found) - len(told)
        if left:
            lines.append(f"  {dataset}: {left} {'more ' * bool(told)}finding{'s' * (left > 1)} in its data card.")
    return ["  What the audit found:", *lines, ""] if lines else []


def _wrapped(line: str) -> list[str]:
    """The line, broken where it is longer than a headline is wide."""
    return textwrap.wrap(line, WIDTH, subsequent_indent="    ", drop_whitespace=True)


def _not_deployed(choice: pd.DataFrame) -> list[str]:
    """Lines on chosen methods that are not deployed."""
    chosen = chosen_intervals(choice)
    return [
        f"  {row.dataset}: chosen is {row.interval_method} ({row.model} {row.preset}), which surrounds no point model."
        for row in chosen[~chosen["deployed"]].itertuples()
    ]
