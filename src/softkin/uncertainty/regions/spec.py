"""Specification of a joint region: an entry of the registry, and a calibrated region."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array


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
    """

    name: str
    title: str
    is_exact: bool
    region: Callable[[Array, Array, NDArray[np.intp], float], Region]
