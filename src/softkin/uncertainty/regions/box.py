"""Joint region: a box around the whole robot, with one limit for all coordinates, each in its own scale."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.conformal import error_scale, joint_scores
from softkin.uncertainty.regions.spec import Region, RegionMethod, of_shape


@dataclass(frozen=True)
class Box:
    """A box with sides in the proportion of `half_widths` (n_coordinates,) in mm, the typical errors on `train`."""

    half_widths: Array
    kind: ClassVar[str] = "box"
    matrix: ClassVar[None] = None

    @property
    def unit_size_mm(self) -> float:
        """Geometric mean of its sides at size 1."""
        return float(np.exp(np.log(2 * self.half_widths).mean()))

    def scores(self, residuals: Array) -> Array:
        """The largest residual in units of the typical errors, (n_rows,)."""
        return joint_scores(residuals, self.half_widths)


def shape(train_residuals: Array, markers: NDArray[np.intp]) -> Box:  # noqa: ARG001
    """Sides proportional to the 90 % quantile of the errors on `train`."""
    return Box(error_scale(np.abs(train_residuals)))


def region(train_residuals: Array, residuals: Array, markers: NDArray[np.intp], confidence_level: float) -> Region:
    """Split conformal prediction of the largest residual, in units of the typical errors on `train`."""
    return of_shape(shape(train_residuals, markers), residuals, confidence_level)


METHOD = RegionMethod("joint_box", "Box", is_exact=True, region=region)
