"""Specification of a point model: an entry of the registry."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from softkin.core.runs import PAPER, Run
from softkin.core.samples import Array, Params, Samples

if TYPE_CHECKING:
    from optuna.trial import BaseTrial

#: The run that the paper puts its intervals around.
PAPERS_RUN = Run("gb", PAPER)
#: Trends on whose residuals a model that extrapolates as a constant may be fitted; the index is the degree.
TRENDS = ("none", "linear", "quadratic")


class Regressor(Protocol):
    """A multi-output scikit-learn regressor: commands (n_rows, n_commands) -> targets, both standardised."""

    def fit(self, X: Array, y: Array) -> Any:
        """Fit on commands X and targets y (n_rows, n_targets), or (n_rows,) of one target."""

    def predict(self, X: Array) -> Any:
        """Targets of commands X."""


def as_drawn(params: Params, n_commands: int, n_rows: int) -> Params:
    """`params`, whatever the number of commands and rows."""
    return params


@dataclass(frozen=True, slots=True, kw_only=True)
class PointModel:
    """What is known of any entry that predicts positions, a model or an ensemble of them.

    `spread(regressor, train, commands)`, where there is one, estimates its own uncertainty: (n_rows, n_targets),
    everything standardised; `is_predictive` says that this is the standard deviation of a whole predictive
    distribution. `is_cheap` admits it to the interval methods that refit (CV+, jackknife+-after-bootstrap). `is_robust`
    says that a few gross errors in `train` cannot move its fit.
    """

    name: str
    title: str
    family: str
    spread: Callable[[Regressor, Samples, Array], Array] | None = None
    is_predictive: bool = False
    is_cheap: bool = False
    is_robust: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelSpec(PointModel):
    """One point model.

    `build(params, seed, threads)` returns an unfitted multi-output scikit-learn regressor that works in
    standardised space. `paper_params` are the fixed settings of the paper's rows, or scikit-learn's own for a model
    that the paper does not have. `search_space(trial)` draws the parameters of a searched model; `first_trials` are
    drawn before the sampler draws on its own. `bounded(params, n_commands, n_rows)` are the parameters that a fit of so
    many rows really has: a polynomial of many commands gets a lower degree.
    """

    build: Callable[[Params, int, int], Regressor]
    paper_params: Params
    search_space: Callable[[BaseTrial], Params]
    first_trials: tuple[Mapping[str, Any], ...]
    bounded: Callable[[Params, int, int], Params] = as_drawn
