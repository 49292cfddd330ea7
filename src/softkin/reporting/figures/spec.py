"""What a figure is, and where the results lie that it is drawn from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeVar

from softkin.core.runs import Run

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True)
class DatasetResults:
    """Where the results of one dataset lie, for the figures: only of what was run.

    `predictions` is run -> file in the order of the pool, `trials` tuned model -> file, `intervals`
    method -> file; `notes` what a reader of a subset must know. `model_titles` are by model, `method_titles` and
    `has_own_regressors` (quantile regressors, in place of a point model) by method.
    """

    dataset: str
    title: str
    table: Path
    predictions: Mapping[Run, Path]
    trials: Mapping[str, Path]
    intervals: Mapping[str, Path]
    point: Path
    interval_metrics: Path
    choice: Path
    conditional: Path
    outside: Path
    spaces: Path
    notes: Mapping[str, str]
    model_titles: Mapping[str, str]
    method_titles: Mapping[str, str]
    has_own_regressors: Mapping[str, bool]


@dataclass(frozen=True, slots=True)
class CampaignResults:
    """Where the results across datasets lie, for the figures. `dataset_titles` and `model_titles` are by name."""

    published_comparison: Path
    dataset_titles: Mapping[str, str]
    model_titles: Mapping[str, str]


Results = TypeVar("Results")


@dataclass(frozen=True, slots=True)
class FigureSpec(Generic[Results]):
    """One figure: `frame(results)` is all that it shows, `plot(frame, results)` draws it, `caption` tells how to read
    it.

    A frame names the runs it shows in columns model, preset, interval_method (empty where there is none); an empty
    one is not drawn.
    """

    name: str
    title: str
    caption: str
    frame: Callable[[Results], pd.DataFrame]
    plot: Callable[[pd.DataFrame, Results], Figure]
