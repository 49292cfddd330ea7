"""What an interval method is, and what it can promise."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import CalibrationData

#: What a calibrated model gives in extrapolation: the intervals of the method of that name, or the same as in-domain.
AUTO, INSIDE = REGIMES = ("auto", "inside")

#: What an interval promises of a new row exchangeable with those it was calibrated on, coordinate by coordinate.
MARGINAL, WEAK, NO_GUARANTEE = GUARANTEES = ("marginal", "marginal at 1 - 2 alpha", "no guarantee")

Data = TypeVar("Data", bound=CalibrationData)


@dataclass(frozen=True, slots=True)
class IntervalMethod(Generic[Data]):
    """One way to put an interval around a predicted position.

    `calibrated_on` is the class of its calibration data. `intervals(data, confidence_levels)` returns (n_levels,
    n_rows, n_coordinates, 2), lower and upper in mm, levels ascending. `guarantee` is one of `GUARANTEES`.
    `rank(n_calibration, level)` is the rank that the law of its coverage on exchangeable rows follows from; None when
    the method calibrates nothing. `has_constant_width`: the same half-width to both sides, on every row.
    `crps(data, true)` (n_rows, n_coordinates) in mm, for a method that gives a distribution.
    """

    name: str
    title: str
    calibrated_on: type[Data]
    guarantee: str
    intervals: Callable[[Data, Sequence[float]], Array]
    rank: Callable[[int, float], int | None] | None = None
    has_constant_width: bool = False
    crps: Callable[[Data, Array], Array] | None = None
