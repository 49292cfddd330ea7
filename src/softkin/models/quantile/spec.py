"""Specification of a quantile regressor: an entry of the registry."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from softkin.core.samples import Params
from softkin.models.spec import as_drawn

if TYPE_CHECKING:
    from optuna.trial import BaseTrial


@dataclass(frozen=True, slots=True)
class QuantileSpec:
    """One quantile regressor.

    `build(params, quantiles, seed, threads)` returns an unfitted regressor of one coordinate, in standardised space,
    that predicts (n_rows, n_quantiles). `paper_params`, `search_space`, `first_trials` and `bounded` are as for a point
    model.
    """

    name: str
    title: str
    build: Callable[[Params, Sequence[float], int, int], Any]
    paper_params: Params
    search_space: Callable[[BaseTrial], Params]
    first_trials: tuple[Mapping[str, Any], ...]
    bounded: Callable[[Params, int, int], Params] = as_drawn
