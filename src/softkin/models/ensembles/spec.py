"""Specification of an ensemble: an entry of the registry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from softkin.models.spec import PointModel

if TYPE_CHECKING:
    from softkin.core.samples import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class EnsembleSpec(PointModel):
    """One way to weight runs, whose weighted mean then predicts.

    `steps(predicted, truth, shares)` returns the weights (n_steps, n_runs) that are tried: none is negative, those of a
    step add up to 1, and the first step is the best run alone. `predicted` (n_runs, n_rows, n_coordinates) is what each
    run predicts of rows of `train` that were held out of its fit, `truth` (n_rows, n_coordinates), both in mm, `shares`
    (n_rows,) by how much each row counts, which add up to 1. The step of the lowest error is the ensemble.
    """

    steps: Callable[[Array, Array, Array], Array]
