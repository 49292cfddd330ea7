"""Which model for which robot, and how sure: a card per robot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd

from softkin.interface import EXTRAPOLATION, TEST, TUNED
from softkin.report.grid import number_text, share_text
from softkin.report.marks import Mark, Marks
from softkin.report.scores import interval_rows


@dataclass(frozen=True, slots=True)
class RobotCard:
    """`facts` are (what, value) pairs in reading order; `answer` and `figure` are empty where nothing was chosen."""

    dataset: str
    title: str
    answer: str
    figure: str
    facts: list[tuple[str, str]]
    sure: str
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
        answer, figure = "No model was chosen: nothing was tuned.", ""
        facts: list[tuple[str, str]] = []
        if "selection" in frames:
            chosen = frames["selection"].set_index("dataset").loc[dataset]
            answer, (figure, facts) = models[chosen["model"]], _errors(frames["point_metrics"], dataset, chosen, models)
        mine = frames["interval_choice"]
        best = mine[(mine["dataset"] == dataset) & mine["chosen"]].iloc[0]
        sure = _how_sure(best, intervals, models, methods)
        cards.append(RobotCard(dataset, about["title"], answer, figure, facts, sure, marks.of_dataset(dataset)))
    return cards


def _errors(
    scores: pd.DataFrame, dataset: str, chosen: pd.Series, models: Mapping[str, str]
) -> tuple[str, list[tuple[str, str]]]:
    mine = scores[(scores["dataset"] == dataset) & (scores["model"] == chosen["model"]) & (scores["preset"] == TUNED)]
    by_subset = mine.set_index("subset")
    test, outside = by_subset.loc[TEST], by_subset.loc[EXTRAPOLATION]
    facts = [
        ("95 % of cases below", number_text(test["euclidean_p95_mm"], "mm")),
        ("beyond the training range", number_text(outside["euclidean_mean_mm"], "mm")),
    ]
    if isinstance(chosen["runner_up"], str) and chosen["runner_up"]:
        errors = [number_text(chosen[name]) for name in ("cv_mae_mm", "runner_up_cv_mae_mm")]
        facts.append(
            ("runner-up", f"{models[chosen['runner_up']]} (cross-validated MAE {errors[1]} against {errors[0]} mm)")
        )
    return number_text(test["euclidean_mean_mm"], "mm"), facts


def _how_sure(best: pd.Series, intervals: pd.DataFrame, models: Mapping[str, str], methods: Mapping[str, str]) -> str:
    key = ("dataset", "model", "preset", "interval_method", "confidence_level")
    same = (intervals[list(key)] == best[list(key)].to_numpy()).all(axis=1)
    kept = intervals[same].set_index("subset")
    level = share_text(best["confidence_level"], digits=0)
    width, held = number_text(best["test_mean_width_mm"], "mm"), share_text(best["test_coverage"])
    text = (
        f"A coordinate's {level} interval ({methods[best['interval_method']]} around {models[best['model']]}, "
        f"{best['preset']}) is {width} wide on average and held the true coordinate in {held} of the test cases; "
        f"{kept.loc[TEST, 'as_promised']} coordinates kept the promise."
    )
    outside = share_text(kept.loc[EXTRAPOLATION, "coverage"])
    return f"{text} Beyond the training range, where nothing is promised, it held {outside}."
