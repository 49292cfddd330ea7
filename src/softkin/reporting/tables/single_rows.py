"""Numbers that hang on a single row of a subset, or on a single coordinate: those that change much without it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from softkin.core.samples import TEST
from softkin.models.spec import PAPERS_RUN
from softkin.reporting.tables.interval_choice import PAPERS_METHOD, RATIO
from softkin.reporting.tables.numbers import number_text

#: A number that changes by more than this share of itself without one row hangs on it.
SHARE = 0.05
KEY = ["dataset", "subset", "model", "preset", "interval_method", "metric"]


class Number(NamedTuple):
    """Key of a number: a score of a run on a subset, of an interval around it where there is a method."""

    dataset: str
    subset: str
    model: str
    preset: str
    metric: str
    interval_method: str = ""


@dataclass(frozen=True, slots=True)
class Hanging:
    """What a number hangs on: without `left_out` ('row 17', or a coordinate) its `value` becomes `without`."""

    left_out: str
    value: float
    without: float

    @property
    def text(self) -> str:
        """'without row 17 it is 0.064'."""
        return f"without {self.left_out} it is {number_text(self.without)}"


def hanging(left_out: pd.DataFrame, share: float = SHARE) -> dict[Number, Hanging]:
    """The numbers that hang on a row or coordinate, each with that which changes it most.

    Parameters:
        left_out: as in left_out.csv.
        share: of itself, by which a number must change.
    """
    if left_out.empty:
        return {}
    rows = pd.concat([left_out, ratios(left_out)], ignore_index=True)
    change = (rows["without"] - rows["value"]).abs() / rows["value"].abs().where(rows["value"] != 0, np.nan)
    rows = rows.assign(change=change)[change > share].sort_values("change", ascending=False)
    first = rows.drop_duplicates(KEY)
    return {
        Number(row["dataset"], row["subset"], row["model"], row["preset"], row["metric"], row["interval_method"]): (
            Hanging(row["left_out"], row["value"], row["without"])
        )
        for row in first.to_dict("records")
    }


def ratios(left_out: pd.DataFrame) -> pd.DataFrame:
    """Winkler scores on test over those of the paper's recipe, with the same row left out of both."""
    scores = left_out[(left_out["metric"] == "winkler_mm") & (left_out["subset"] == TEST)]
    is_recipe = (scores["interval_method"] == PAPERS_METHOD) & (scores["model"] == PAPERS_RUN.model)
    recipe = scores[is_recipe & (scores["preset"] == PAPERS_RUN.preset)]
    both = scores.merge(recipe[["dataset", "left_out", "value", "without"]], on=["dataset", "left_out"])
    both = both[(both["value_y"] > 0) & (both["without_y"] > 0)]
    value, without = both["value_x"] / both["value_y"], both["without_x"] / both["without_y"]
    return both[[*KEY, "left_out"]].assign(metric=RATIO, value=value, without=without)


def of_runs(found: Mapping[Number, Hanging], runs: pd.DataFrame, metric: str) -> dict[tuple[str, str], Hanging]:
    """(dataset, subset) -> what a metric of a dataset's run hangs on; `runs` has dataset, model and preset."""
    wanted: dict[str, tuple[Any, Any]] = {row.dataset: (row.model, row.preset) for row in runs.itertuples()}
    return {
        (key.dataset, key.subset): what
        for key, what in found.items()
        if key.metric == metric and not key.interval_method and wanted.get(key.dataset) == (key.model, key.preset)
    }
