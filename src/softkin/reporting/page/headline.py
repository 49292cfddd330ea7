"""A card per robot: the deployed model with its errors, the deployed interval with its coverage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.reporting.page.choices import DEPLOYED, marks_of_candidate
from softkin.reporting.page.interval_rows import interval_rows
from softkin.reporting.page.marks import Mark, Marks
from softkin.reporting.tables.interval_choice import deployed_intervals, why_another_is_deployed
from softkin.reporting.tables.joint_intervals import joint_scores
from softkin.reporting.tables.numbers import assessed_text, length_text, number_text, share_text
from softkin.reporting.titles import Titles
from softkin.training.selection import deployed

#: (name, value) pairs in reading order.
Facts = list[tuple[str, str]]


@dataclass(frozen=True, slots=True)
class Errors:
    """The `model` that is deployed, its `marks`, its `mean` error on test, further `facts`, and a `remark` where a few
    rows set that mean.
    """

    model: str
    marks: tuple[Mark, ...]
    mean: str
    facts: Facts
    remark: str = ""


@dataclass(frozen=True, slots=True)
class Interval:
    """The `method` around its model, its `marks` (deployed, chosen), `facts` on it, and where another one is chosen why
    (`reason`).
    """

    method: str
    marks: tuple[Mark, ...]
    facts: Facts
    reason: str = ""


@dataclass(frozen=True, slots=True)
class RobotCard:
    """What the headline says of one dataset; `errors` is None where no model was searched, hence none chosen."""

    dataset: str
    title: str
    errors: Errors | None
    interval: Interval
    marks: tuple[Mark, ...]


def robot_cards(
    frames: Mapping[str, pd.DataFrame], descriptions: Mapping[str, Mapping[str, Any]], titles: Titles, marks: Marks
) -> list[RobotCard]:
    """One card per dataset, from point_metrics, interval_metrics, interval_choice and, where searched, selection."""
    choice = frames["interval_choice"]
    scores, best = interval_rows(frames["interval_metrics"]), deployed_intervals(choice)
    reasons = why_another_is_deployed(choice, titles)
    joint = joint_scores(frames["interval_metrics"], best)
    cards = []
    for dataset, description in descriptions.items():
        errors = None
        if "selection" in frames:
            selected = deployed(frames["selection"]).set_index("dataset").loc[dataset]
            errors = _errors(frames["point_metrics"], dataset, selected, titles, marks.units[dataset])
        unit = marks.units[dataset]
        interval = _interval(best.loc[dataset], scores, titles, reasons.get(dataset, ""), unit)
        if dataset in joint.index:
            interval = replace(interval, facts=[*interval.facts, *_whole_poses(joint.loc[dataset], unit)])
        if "conditional_coverage" in frames:
            conditional = frames["conditional_coverage"]
            found = _where_it_holds_least(conditional[conditional["dataset"] == dataset])
            interval = replace(interval, facts=[*interval.facts, *found])
        cards.append(RobotCard(dataset, description["title"], errors, interval, marks.of_dataset(dataset)))
    return cards


def _errors(scores: pd.DataFrame, dataset: str, selected: pd.Series, titles: Titles, unit: str) -> Errors:
    run = (scores["dataset"] == dataset) & (scores["model"] == selected["model"])
    by_subset = scores[run & (scores["preset"] == selected["preset"])].set_index("subset")
    test, extrapolation = by_subset.loc[TEST], by_subset.loc[EXTRAPOLATION]
    facts = [
        ("95 % of test cases below", length_text(test["euclidean_p95_mm"], unit)),
        ("mean error, extrapolation", length_text(extrapolation["euclidean_mean_mm"], unit)),
    ]
    if isinstance(selected["runner_up"], str) and selected["runner_up"]:
        ratio = number_text(selected["runner_up_ratio"])
        facts.append(("runner-up", f"{titles.models[selected['runner_up']]}, {ratio} times the score"))
    is_skewed = test["euclidean_mean_mm"] > test["euclidean_p95_mm"]
    remark = "A few gross errors set the mean, which exceeds the 95th percentile." if is_skewed else ""
    model = titles.run(selected["model"], selected["preset"])
    return Errors(model, (DEPLOYED,), length_text(test["euclidean_mean_mm"], unit), facts, remark)


def _beyond(best: pd.Series) -> str:
    """The coverage of an interval in extrapolation, or why there is none."""
    text = assessed_text(best["extrapolation_coverage"], best["extrapolation_assessable"])
    return text if best["extrapolation_assessable"] else f"{text}: {best['extrapolation_commands']} distinct commands"


def _interval(best: pd.Series, scores: pd.DataFrame, titles: Titles, reason: str, unit: str) -> Interval:
    key = ["dataset", "model", "preset", "interval_method", "confidence_level"]
    by_subset = scores[(scores[key] == best[key].to_numpy()).all(axis=1)].set_index("subset")
    level = share_text(best["confidence_level"], 0)
    facts = [
        (f"mean width of a {level} interval", length_text(best["test_mean_width_mm"], unit)),
        ("coverage, test", share_text(best["test_coverage"])),
        ("coordinates covered as guaranteed", str(by_subset.loc[TEST, "as_guaranteed"])),
        ("coverage, extrapolation (no guarantee)", _beyond(best)),
        ("mean width, extrapolation", length_text(best["extrapolation_mean_width_mm"], unit)),
    ]
    method = f"{titles.methods[best['interval_method']]} around {titles.run(best['model'], best['preset'])}"
    return Interval(method, marks_of_candidate(best["chosen"], best["deployed"]), facts, reason)


def _whole_poses(joint: pd.Series, unit: str) -> Facts:
    """What is said of joint intervals, beside how often single ones hold a whole pose."""
    return [
        ("whole poses within all intervals, test", share_text(joint["single_test"])),
        (f"whole poses within joint intervals ({joint['shape']}), test", share_text(joint["test"])),
        ("the same, extrapolation (no guarantee)", assessed_text(joint["extrapolation"], joint["assessable"])),
        ("side of a cube of a joint interval's volume", length_text(joint["size_mm"], unit)),
    ]


def _where_it_holds_least(conditional: pd.DataFrame) -> Facts:
    """Of the deployed intervals on test: the coverage where poses may fail, and in the worst small regions."""
    facts = []
    for row in conditional[conditional["by"] == "failure"].itertuples():
        rows = "rows that may fail" if row.group == "may fail" else "other rows"
        facts.append((f"coverage of {row.n_rows} {rows}, test", share_text(row.coverage)))
    regions, worst = conditional[conditional["by"] == "small_region"].itertuples(), "the worst on validation"
    return facts + [(f"coverage of {of.n_rows} rows at {of.group}, {worst}", share_text(of.coverage)) for of in regions]
