"""Specification of a joint region: an entry of the registry, and a calibrated region."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.conformal import conformal_limit

#: What the region of a calibrated model is called in tables, beside interval methods and regions.
JOINT_INTERVALS, JOINT_TITLE = "joint_intervals", "Joint intervals, deployed"


class Shape(Protocol):
    """A region around a predicted pose up to its size, known from `train` alone; of the moving coordinates, in mm."""

    @property
    def kind(self) -> str:
        """`box` or `ellipsoids`."""
        ...

    @property
    def unit_size_mm(self) -> float:
        """Side of a cube of the volume that the region has at size 1."""
        ...

    @property
    def half_widths(self) -> Array:
        """Half the extent (n_coordinates,) of the region of size 1 along each axis."""
        ...

    @property
    def matrix(self) -> Array | None:
        """Of ellipsoids of size 1, a block A (n_coordinates, n_coordinates) in mm2 for each marker, whose residuals r
        in it have r' A^-1 r <= 1; None: a box.
        """
        ...

    def scores(self, residuals: Array) -> Array:
        """The size (n_rows,) from which on the region holds a residual (n_rows, n_coordinates)."""
        ...


@dataclass(frozen=True, slots=True)
class Region:
    """A region around a predicted pose, the same at every command. `covers` maps residuals (n_rows, n_coordinates) in
    mm to (n_rows,); `size_mm` is the side of a cube of the same volume in all moving coordinates together.
    """

    covers: Callable[[Array], NDArray[np.bool_]]
    size_mm: float


@dataclass(frozen=True, slots=True)
class RegionMethod:
    """One shape of region that holds all moving coordinates at once.

    `region(train_residuals, calibration_residuals, markers, confidence_level)`: residuals (n_rows, n_coordinates) in
    mm of the moving coordinates; `markers` (n_coordinates,) says which marker each belongs to. `is_exact`: its joint
    coverage has the beta-binomial distribution of a conformal rank; else it is at least the nominal level.
    `is_divided`: each coordinate has its own rank, at the miscoverage divided by their number.
    """

    name: str
    title: str
    is_exact: bool
    region: Callable[[Array, Array, NDArray[np.intp], float], Region]
    is_divided: bool = False


def divided(confidence_level: float, n_parts: int) -> float:
    """The level of each of `n_parts` that all hold at the level at least (Bonferroni)."""
    return 1 - (1 - confidence_level) / n_parts if n_parts > 1 else confidence_level


def of_shape(shape: Shape, residuals: Array, confidence_level: float) -> Region:
    """The region of a shape whose size is the conformal limit of the residuals of the calibration set."""
    limit = conformal_limit(shape.scores(residuals), confidence_level)
    return Region(
        covers=lambda new: np.asarray(shape.scores(new) <= limit),
        size_mm=shape.unit_size_mm * limit,
    )


def log_ball_volume(dimensions: Array) -> Array:
    """Logarithm of the volume of the unit ball in each number of dimensions."""
    return np.array([0.5 * n * math.log(math.pi) - math.lgamma(0.5 * n + 1) for n in dimensions])
