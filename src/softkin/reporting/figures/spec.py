"""The specification of a figure, and the files of results that figures are drawn from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeVar

from softkin.core.runs import Run
from softkin.core.units import MM

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True)
class DatasetResults:
    """Paths of one dataset's results, of what was run, and the titles of models and methods.

    `predictions` maps a run to its file in the order of the pool, `trials` a tuned model, `intervals` a method; `notes`
    maps a subset to what its reader must know, a leak for instance. `model_titles` are by model, `method_titles` and
    `has_own_regressors` (quantile regressors in place of a point model) by method. `unit` is that of positions, errors
    and widths; columns of frames keep their names.
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
    extrapolation: Path
    target_spaces: Path
    notes: Mapping[str, str]
    model_titles: Mapping[str, str]
    method_titles: Mapping[str, str]
    has_own_regressors: Mapping[str, bool]
    unit: str = MM


@dataclass(frozen=True, slots=True)
class CampaignResults:
    """Paths of the results across datasets; `dataset_titles` and `model_titles` are by name. `learning_curve` is None
    where there are none.
    """

    published_comparison: Path
    dataset_titles: Mapping[str, str]
    model_titles: Mapping[str, str]
    learning_curve: Path | None = None


Results = TypeVar("Results")


@dataclass(frozen=True, slots=True)
class FigureSpec(Generic[Results]):
    """One figure: `frame(results)` returns all numbers that it shows, `plot(frame, results)` draws them.

    `caption` says what is drawn, where to look, and what a good and a bad one look like. A frame names the runs it
    shows in the columns model, preset, interval_method (empty where there is none); an empty frame is not drawn.
    """

    name: str
    title: str
    caption: str
    frame: Callable[[Results], pd.DataFrame]
    plot: Callable[[pd.DataFrame, Results], Figure]
