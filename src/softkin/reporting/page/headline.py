"""Which model for which robot, and how sure: a card per robot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.reporting.page.grid import number_text, share_text
from softkin.reporting.page.marks import Mark, Marks
from softkin.reporting.page.scores import interval_rows
from softkin.reporting.tables.interval_choice import given_intervals
from softkin.training.selection import deployed

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

#: (what, value) pairs in reading order.
Facts = list[tuple[str, str]]


@dataclass(frozen=True, slots=True)
class RobotCard:
    """`answer` names the model, `figure` its mean error, `interval` what the facts `sure` are about; `figure`, `errors`
    and `remark` are empty where there is none.
    """

    dataset: str
    title: str
    answer: str
    figure: str
    errors: Facts
    remark: str
    interval: str
    sure: Facts
    marks: tuple[Mark, ...]


def robot_cards(
    frames: Mapping[str, pd.DataFrame],
    descriptions: Mapping[str, Mapping[str, Any]],
    models: Mapping[str, str],
    methods: Mapping[str, str],
    marks: Marks,
) -> list[RobotCard]:
    """One card per dataset, from point_metrics, interval_metrics, interval_choice and, where tuned, selection."""
    intervals = interval_rows(frames["interval_metrics"])
    cards = []
    for dataset, about in descriptions.items():
        answer, figure, remark = "No model was chosen: nothing was tuned.", "", ""
        errors: Facts = []
        if "selection" in frames:
            chosen = deployed(frames["selection"]).set_index("dataset").loc[dataset]
            answer = models[chosen["model"]]
            figure, errors, remark = _errors(frames["point_metrics"], dataset, chosen, models)
        best = given_intervals(frames["interval_choice"]).loc[dataset]
        interval, sure = _how_sure(best, intervals, models, methods)
        about_marks = marks.of_dataset(dataset)
        cards.append(RobotCard(dataset, about["title"], answer, figure, errors, remark, interval, sure, about_marks))
    return cards


def _errors(scores: pd.DataFrame, dataset: str, chosen: pd.Series, models: Mapping[str, str]) -> tuple[str, Facts, str]:
    """The mean error on test; further errors; a remark where a few rows set that mean."""
    mine = scores[(scores["dataset"] == dataset) & (scores["model"] == chosen["model"])]
    by_subset = mine[mine["preset"] == chosen["preset"]].set_index("subset")
    test, outside = by_subset.loc[TEST], by_subset.loc[EXTRAPOLATION]
    facts = [
        ("95 % of cases below", length(test["euclidean_p95_mm"])),
        ("mean beyond the training range", length(outside["euclidean_mean_mm"])),
    ]
    if isinstance(chosen["runner_up"], str) and chosen["runner_up"]:
        ratio = number_text(chosen["runner_up_ratio"])
        facts.append(("runner-up", f"{models[chosen['runner_up']]}, {ratio} times the error"))
    is_skewed = test["euclidean_mean_mm"] > test["euclidean_p95_mm"]
    remark = "A few gross misses set the mean, which exceeds the 95th percentile." if is_skewed else ""
    return length(test["euclidean_mean_mm"]), facts, remark


def _how_sure(
    best: pd.Series, intervals: pd.DataFrame, models: Mapping[str, str], methods: Mapping[str, str]
) -> tuple[str, Facts]:
    """What the interval is; how wide, and how often it held."""
    key = ["dataset", "model", "preset", "interval_method", "confidence_level"]
    same = (intervals[key] == best[key].to_numpy()).all(axis=1)
    kept = intervals[same].set_index("subset")
    level = share_text(best["confidence_level"], digits=0)
    interval = f"{methods[best['interval_method']]} around {models[best['model']]}, {best['preset']}"
    return interval, [
        (f"mean width of a {level} interval", length(best["test_mean_width_mm"])),
        ("held the true coordinate, test", share_text(best["test_coverage"])),
        ("coordinates that keep the promise", str(kept.loc[TEST, "as_promised"])),
        ("held beyond the range, unpromised", share_text(best["extrapolation_coverage"])),
        ("mean width there", length(best["extrapolation_mean_width_mm"])),
    ]


def length(value: float) -> str:
    """'0.509 mm', '7.65 × 10⁻⁷ mm'."""
    digits, exponent, power = number_text(value).partition("e")
    return f"{digits} × 10{str(int(power)).translate(RAISED)} mm" if exponent else f"{digits} mm"
