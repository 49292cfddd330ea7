"""The shared vocabulary: subsets, samples, models. Imports nothing of ours.

Array shapes, stated once: commands ``(n_rows, n_commands)``; positions ``(n_rows, n_coordinates)`` in mm with
``n_coordinates = 3 * n_markers``, ordered m1_x, m1_y, m1_z, m2_x, ...
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure
    from optuna.trial import BaseTrial

Array = NDArray[np.float64]
Params = dict[str, Any]

TRAIN, VALIDATION, TEST, EXTRAPOLATION = SUBSETS = ("train", "validation", "test", "extrapolation")
#: Where a model's parameters are from: the paper; a search for the lowest error at commands like those of `train`; or
#: at commands beyond them.
PAPER, TUNED, OUTER = PRESETS = ("paper", "tuned", "outer")
SEARCHED = (TUNED, OUTER)
#: What the paper puts its intervals around, (model, preset), and at which level.
PAPERS_RUN = ("gb", PAPER)
PAPERS_LEVEL = 0.9

#: What a model that ends at a constant may be fitted on the residuals of: the degree of a polynomial is the place.
TRENDS = ("none", "linear", "quadratic")

#: A coordinate whose range on `train` stays below this (mm) is constant: it says nothing about a model.
CONSTANT_RANGE_MM = 1e-6


class SoftkinError(Exception):
    """Bad input, told so that a person can mend it: what is wrong, where, and what to do."""


@dataclass(frozen=True, slots=True)
class Samples:
    """Rows of one subset: `commands` (n_rows, n_commands), `positions` (n_rows, n_coordinates) in mm."""

    commands: Array
    positions: Array

    def __len__(self) -> int:
        return len(self.commands)


@dataclass(frozen=True, slots=True)
class ModelSpec:
    """One model of the pool.

    `build(params, seed, threads)` returns an unfitted multi-output scikit-learn regressor that works in
    standardised space. `paper_params` are the fixed settings of the paper's rows, or scikit-learn's own for a model
    that the paper does not have. `search_space(trial)` draws the parameters of a searched model; `first_trials` are
    drawn before it samples on its own. `spread(regressor, train, commands)`, if the model has one, is what it says
    itself of its uncertainty: (n_rows, n_targets), everything standardised; `is_predictive` that this is the standard
    deviation of a whole predictive distribution. `is_cheap` admits it to the methods that refit (CV+,
    jackknife+-after-bootstrap).
    """

    name: str
    title: str
    family: str
    build: Callable[[Params, int, int], Any]
    paper_params: Params
    search_space: Callable[[BaseTrial], Params]
    first_trials: tuple[Mapping[str, Any], ...]
    spread: Callable[[Any, Samples, Array], Array] | None = None
    is_predictive: bool = False
    is_cheap: bool = False


@dataclass(frozen=True, slots=True)
class TargetSpace:
    """What a model is fitted to in place of positions in mm.

    `transformer(skip_constant, base)` returns an unfitted invertible transformer: `fit(positions, commands)`,
    `transform(positions)`, `inverse_transform(targets)`, `inverse_spread(targets, spread)`; positions (n_rows,
    n_coordinates) in mm, targets (n_rows, n_targets) standardised. `base` is what the dataset's entry declares of the
    base.
    """

    name: str
    title: str
    transformer: Callable[[bool, Mapping[str, Any] | None], Any]


def command_columns(n_commands: int) -> list[str]:
    """Names u1, u2, ... of the command columns."""
    return [f"u{i + 1}" for i in range(n_commands)]


def coordinate_columns(n_markers: int) -> list[str]:
    """Names m1_x, m1_y, m1_z, m2_x, ... of the coordinate columns."""
    return [f"m{i + 1}_{axis}" for i in range(n_markers) for axis in "xyz"]


def informative_coordinates(train_positions: Array) -> NDArray[np.bool_]:
    """Mask (n_coordinates,) of the coordinates that move on `train` (range above `CONSTANT_RANGE_MM`)."""
    return np.asarray(np.ptp(train_positions, axis=0) > CONSTANT_RANGE_MM)


@dataclass(frozen=True, slots=True)
class QuantileSpec:
    """One learner of quantiles. `build(params, quantiles, seed, threads)` returns an unfitted regressor of one
    coordinate, in standardised space, that predicts (n_rows, n_quantiles). The rest is as for a model.
    """

    name: str
    title: str
    build: Callable[[Params, Sequence[float], int, int], Any]
    paper_params: Params
    search_space: Callable[[BaseTrial], Params]
    first_trials: tuple[Mapping[str, Any], ...]


@dataclass(frozen=True, slots=True)
class Evidence:
    """What an interval method sees of one fitted model: its output on `validation` with the truth, and on new rows.

    `calibration` and `new` are predicted positions (n_rows, n_coordinates) for a method on predictions, or predicted
    quantiles (n_levels, n_rows, n_coordinates, 2) for a method on quantiles; `truth` is (n_calibration,
    n_coordinates); the spreads are shaped like the predictions; all in mm. Commands are (n_rows, n_commands).
    """

    calibration: Array
    truth: Array
    new: Array
    train_spread: Array | None = None
    calibration_spread: Array | None = None
    new_spread: Array | None = None
    train_commands: Array | None = None
    calibration_commands: Array | None = None
    new_commands: Array | None = None


@dataclass(frozen=True, slots=True)
class RefitEvidence:
    """What a method that refits sees: a model fitted again and again on parts of `train`.

    `inside` holds the rows of `train` of each fit; `train` (n_fits, n_train, n_coordinates) and `new` (n_fits, n_new,
    n_coordinates) what each predicts; `truth` (n_train, n_coordinates); in mm.
    """

    inside: Sequence[NDArray[np.intp]]
    train: Array
    truth: Array
    new: Array


@dataclass(frozen=True, slots=True)
class Shell:
    """What a model fitted on the inner core of `train` predicts of the shell around it.

    `predicted` and `truth` are (n_shell, n_coordinates) in mm, `core_commands` and `commands` (n_rows, n_commands).
    """

    core_commands: Array
    commands: Array
    predicted: Array
    truth: Array


@dataclass(frozen=True, slots=True)
class ShellEvidence:
    """What a method for commands outside `train` sees: the `deployed` model, fitted on all of `train`, and the same
    model fitted on its cores, the smallest first. `norm` takes commands (n_rows, n_commands) to how far out they lie
    (n_rows,). `inside` (n_levels, n_rows, n_coordinates, 2) are the bounds that new rows get inside the training
    region; None: those of split conformal prediction. `inside_is_informed`: they widen where the model is unsure, not
    with the distance alone.
    """

    deployed: Evidence
    shells: Sequence[Shell]
    norm: Callable[[Array], Array]
    inside: Array | None = None
    inside_is_informed: bool = False

    @property
    def truth(self) -> Array:
        """That of the deployed model's calibration rows."""
        return self.deployed.truth


#: What the calibrated model of a robot gives outside the training region: the intervals of the method of that name,
#: or the same as inside.
AUTO, INSIDE = REGIMES = ("auto", "inside")

#: What an interval promises of a new row exchangeable with those it was calibrated on, coordinate by coordinate.
MARGINAL, WEAK, NO_GUARANTEE = GUARANTEES = ("marginal", "marginal at 1 - 2 alpha", "no guarantee")


@dataclass(frozen=True, slots=True)
class IntervalMethod:
    """One way to put an interval around a predicted position.

    `on` says what it starts from: `predictions`, `spreads` (predictions of a model with a spread), `predictive`
    (of one whose spread is a standard deviation), `quantiles`, `folds`, `resamples` or `shells`. `intervals(evidence,
    confidence_levels)` returns (n_levels, n_rows, n_coordinates, 2), lower and upper in mm, levels ascending.
    `guarantee` is one of `GUARANTEES`. `rank(n_calibration, level)` is what the law of its coverage on exchangeable
    rows follows from; None when the method calibrates nothing. `has_constant_width`: the same half-width to both
    sides, on every row. `crps(evidence, true)` (n_rows, n_coordinates) in mm, for a method that gives a distribution.
    """

    name: str
    title: str
    on: str
    guarantee: str
    intervals: Callable[[Any, Sequence[float]], Array]
    rank: Callable[[int, float], int | None] | None = None
    has_constant_width: bool = False
    crps: Callable[[Any, Array], Array] | None = None


@dataclass(frozen=True, slots=True)
class Region:
    """A region around a predicted pose, the same at every command. `covers` takes residuals (n_rows, n_coordinates)
    to (n_rows,); `size_mm` is the side of a cube of the same volume in all moving coordinates together.
    """

    covers: Callable[[Array], NDArray[np.bool_]]
    size_mm: float


@dataclass(frozen=True, slots=True)
class RegionMethod:
    """One shape of region that holds all moving coordinates at once.

    `region(train_residuals, calibration_residuals, markers, confidence_level)`: residuals (n_rows, n_coordinates) in
    mm of the moving coordinates, `markers` (n_coordinates,) says whose they are. `is_exact`: its joint coverage
    follows the exact law of a conformal rank; else it is at least the level.
    """

    name: str
    title: str
    is_exact: bool
    region: Callable[[Array, Array, NDArray[np.intp], float], Region]


@dataclass(frozen=True, slots=True)
class DatasetResults:
    """Where the results of one dataset lie, for the figures: only of what was run.

    `predictions` is (model, preset) -> file in the order of the pool, `trials` tuned model -> file, `intervals`
    method -> file; `notes` what a reader of a subset must know. `model_titles` are by model, `method_titles` and
    `on_quantiles` (whether it has a learner of its own) by method.
    """

    dataset: str
    title: str
    table: Path
    predictions: Mapping[tuple[str, str], Path]
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
    on_quantiles: Mapping[str, bool]


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
