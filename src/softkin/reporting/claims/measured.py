"""What a run measured, as the rules of claims look it up; the same with a row left out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Self

import pandas as pd

from softkin.core.runs import PAPERS_LEVEL, PRESETS
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.data.audit.findings import leaking_subsets
from softkin.reporting.tables.published_intervals import AVERAGES
from softkin.uncertainty.intervals.spec import NO_GUARANTEE

#: Fewer distinct commands of a subset than this say nothing of a model.
FEWEST_COMMANDS = 20
#: A promised coverage whose p-value is below this, adjusted for the number of coordinates, is not as promised.
CHANCE = 0.05
AVERAGE, JOINT = "mean_informative", "joint"


class Point(NamedTuple):
    """Key of an error: of a run on a subset."""

    dataset: str
    subset: str
    model: str
    preset: str
    metric: str = "rmse_mm"


class Interval(NamedTuple):
    """Key of a score of an interval, at the paper's level, averaged over moving coordinates."""

    dataset: str
    subset: str
    model: str
    preset: str
    method: str
    metric: str


@dataclass(frozen=True, slots=True)
class Measured:
    """Tables of a run by key, of datasets that can say something of the paper: published, and complete.

    `twins` are datasets that hold the rows of another one (recorded in time); `bands` has (coordinates whose coverage
    agrees with the level but for chance, moving coordinates) and `joint` (share of poses held as a whole, whether it is
    the level but for chance) by dataset, subset, model, preset and method; `leaks` are (dataset, subset) whose commands
    stand in train, `few` those of too few distinct commands. `frames` are the other tables, by name.
    """

    datasets: tuple[str, ...]
    twins: frozenset[str]
    points: Mapping[Point, float]
    intervals: Mapping[Interval, float]
    bands: Mapping[tuple[str, ...], tuple[int, int]]
    joint: Mapping[tuple[str, ...], tuple[float, bool]]
    leaks: frozenset[tuple[str, str]]
    few: frozenset[tuple[str, str]]
    frames: Mapping[str, pd.DataFrame]
    descriptions: Mapping[str, Mapping[str, Any]]
    cards: Mapping[str, Mapping[str, Any]]

    @property
    def presets(self) -> list[str]:
        """The presets that were run."""
        return [preset for preset in PRESETS if any(key.preset == preset for key in self.points)]

    def robots(self) -> list[str]:
        """Datasets that are no twins."""
        return [name for name in self.datasets if name not in self.twins]

    def places(self, subsets: Iterable[str] = (TEST, EXTRAPOLATION)) -> list[tuple[str, str]]:
        """(dataset, subset) whose scores say how well a model predicts: neither leak nor too few commands."""
        pairs = [(name, subset) for name in self.robots() for subset in subsets]
        return [pair for pair in pairs if pair not in self.leaks and pair not in self.few]

    def errors(self, place: tuple[str, str], preset: str, models: Iterable[str]) -> dict[str, float]:
        """RMSE (mm) by model; empty where one of them was not run."""
        found = {model: self.points.get(Point(*place, model, preset)) for model in models}
        return {} if None in found.values() else {model: float(error or 0.0) for model, error in found.items()}

    def score(self, dataset: str, subset: str, run: tuple[str, str], method: str, metric: str) -> float | None:
        """A score of an interval around a run; None where there is none."""
        return self.intervals.get(Interval(dataset, subset, *run, method, metric))

    def without(self, left_out: pd.DataFrame) -> Self:
        """The same with one row left out: `left_out` are the rows of left_out.csv of one subset and row."""
        rows = left_out.to_dict("records")
        points = {
            Point(*(row[name] for name in Point._fields)): row["without"] for row in rows if not row["interval_method"]
        }
        intervals = {
            Interval(
                row["dataset"], row["subset"], row["model"], row["preset"], row["interval_method"], row["metric"]
            ): (row["without"])
            for row in rows
            if row["interval_method"]
        }
        return replace(self, points={**self.points, **points}, intervals={**self.intervals, **intervals})


def measured(
    frames: Mapping[str, pd.DataFrame],
    descriptions: Sequence[Mapping[str, Any]],
    cards: Sequence[Mapping[str, Any]],
) -> Measured:
    """What the tables of a run hold that claims are judged by.

    Parameters:
        frames: the tables of the run, by name.
        descriptions: of the datasets.
        cards: their data cards, in the same order.
    """
    by_name = {str(about["dataset"]): about for about in descriptions}
    known = dict(zip(by_name, cards, strict=True))
    complete = [name for name, about in by_name.items() if about.get("origin") == "published" and not about["is_cut"]]
    recorded = frames.get("recorded")
    at_level = frames["interval_metrics"]
    at_level = at_level[at_level["confidence_level"] == PAPERS_LEVEL]
    distinct = {name: card["checks"].get("few_commands", {}).get("distinct", {}) for name, card in known.items()}
    return Measured(
        datasets=tuple(complete),
        twins=frozenset() if recorded is None else frozenset(map(str, recorded["dataset"])),
        points=_points(frames["point_metrics"]),
        intervals=_intervals(at_level),
        bands=_bands(at_level, by_name),
        joint=_joint(at_level),
        leaks=frozenset((name, subset) for name, card in known.items() for subset in leaking_subsets(card)),
        few=frozenset(
            (name, subset) for name, counts in distinct.items() for subset, n in counts.items() if n < FEWEST_COMMANDS
        ),
        frames=frames,
        descriptions=by_name,
        cards=known,
    )


def _points(scores: pd.DataFrame) -> dict[Point, float]:
    metrics = ["rmse_mm", "mae_mm", "r2"]
    rows = scores[["dataset", "subset", "model", "preset", *metrics]].to_dict("records")
    return {
        Point(row["dataset"], row["subset"], row["model"], row["preset"], metric): row[metric]
        for row in rows
        for metric in metrics
    }


KEY = ["dataset", "subset", "model", "preset", "interval_method"]


def _intervals(at_level: pd.DataFrame) -> dict[Interval, float]:
    metrics = ["coverage", "mean_width_mm", "winkler_mm"]
    means = at_level.loc[at_level["coordinate"] == AVERAGE, [*KEY, *metrics]]
    return {
        Interval._make([*(row[name] for name in KEY), metric]): row[metric]
        for row in means.to_dict("records")
        for metric in metrics
    }


def _bands(at_level: pd.DataFrame, about: Mapping[str, Mapping[str, Any]]) -> dict[tuple[str, ...], tuple[int, int]]:
    single = at_level[~at_level["coordinate"].isin(AVERAGES)]
    constant = {(name, each) for name, of in about.items() for each in of.get("constant_coordinates", [])}
    moves = [key not in constant for key in zip(single["dataset"], single["coordinate"], strict=True)]
    moving = single[moves]
    promised = moving["coverage_p_value_holm"].notna()
    by_chance = (moving["coverage_low"] <= PAPERS_LEVEL) & (moving["coverage_high"] >= PAPERS_LEVEL)
    as_said = (moving["coverage_p_value_holm"] >= CHANCE).where(promised, by_chance).astype(bool)
    counts = as_said.groupby([moving[name] for name in KEY]).agg(["sum", "count"])
    return {tuple(map(str, key)): (int(n), int(of)) for key, n, of in counts.itertuples()}


def _joint(at_level: pd.DataFrame) -> dict[tuple[str, ...], tuple[float, bool]]:
    whole = at_level[at_level["coordinate"] == JOINT]
    keys = list(zip(*(whole[name] for name in KEY), strict=True))
    promised = whole["guarantee"] != NO_GUARANTEE
    enough = (whole["coverage"] >= whole["coverage_low"]).where(promised, whole["coverage_high"] >= PAPERS_LEVEL)
    return dict(zip(keys, zip(whole["coverage"], map(bool, enough), strict=True), strict=True))
