"""Specification of an interval method: an entry of the registry, and the guarantees there are."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import CalibrationData, PointCalibration, QuantileCalibration

#: Intervals of a calibrated model in extrapolation: those of the method of that name, or the same as in-domain.
AUTO, IN_DOMAIN = REGIMES = ("auto", "in_domain")

#: Guaranteed coverage of a new row exchangeable with those it was calibrated on, coordinate by coordinate.
MARGINAL, WEAK, NO_GUARANTEE = GUARANTEES = ("marginal", "marginal at 1 - 2 alpha", "no guarantee")

Data = TypeVar("Data", bound=CalibrationData)


@dataclass(frozen=True, slots=True)
class Scaled:
    """A method whose bounds are the prediction plus `sides(confidence_levels)` (n_levels, n_coordinates, 2) in mm times
    the difficulty of the command; the `difficulty` is a kind and its numbers, as `PlainRobot` reads them.
    """

    sides: Callable[[Sequence[float]], Array]
    difficulty: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class IntervalMethod(Generic[Data]):
    """One way to put an interval around a predicted position.

    `calibrated_on` is the class of its calibration data. `intervals(data, confidence_levels)` returns (n_levels,
    n_rows, n_coordinates, 2), lower and upper in mm, levels ascending. `guarantee` is one of `GUARANTEES`.
    `rank(n_calibration, level)` is the rank of which its coverage on exchangeable rows is beta-binomial; None when the
    method calibrates nothing. `has_constant_width`: symmetric, of the same width on every row.
    `crps(data, true)` (n_rows, n_coordinates) in mm, for a method that gives a distribution. `at_fitted_levels`: it has
    intervals at those levels only that quantiles were fitted for. `scaled(data)` is the method in plain numbers, from
    which one command is answered and models are exported; a method around a point model without it is slower.
    """

    name: str
    title: str
    calibrated_on: type[Data]
    guarantee: str
    intervals: Callable[[Data, Sequence[float]], Array]
    rank: Callable[[int, float], int | None] | None = None
    has_constant_width: bool = False
    crps: Callable[[Data, Array], Array] | None = None
    at_fitted_levels: bool = False
    scaled: Callable[[Data], Scaled] | None = None

    def levels(self, data: Data, confidence_levels: Sequence[float]) -> list[float]:
        """Those of the levels that it has intervals for, on these calibration data."""
        fitted = data.levels if isinstance(data, QuantileCalibration) and self.at_fitted_levels else confidence_levels
        return [level for level in confidence_levels if level in fitted]


Point = TypeVar("Point", bound=PointCalibration)


def as_at_zero(intervals: Callable[[Point, Sequence[float]], Array], data: Point) -> Scaled:
    """`scaled`, once the first argument is given, of a method that puts the same bounds around every prediction."""
    zero = replace(data, new=np.zeros((1, data.truth.shape[1])), new_commands=data.train_commands[:1])
    return Scaled(lambda confidence_levels: intervals(zero, confidence_levels)[:, 0], {"kind": "none"})
