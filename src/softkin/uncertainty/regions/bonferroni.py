"""Joint region, the baseline: an interval per coordinate, each at the miscoverage divided by their number."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.conformal import conformal_limit
from softkin.uncertainty.regions.spec import Region, RegionMethod, divided


def region(train_residuals: Array, residuals: Array, markers: NDArray[np.intp], confidence_level: float) -> Region:  # noqa: ARG001
    """Joint coverage is at least the nominal level, for any dependence of coordinates, and often far above it."""
    single = divided(confidence_level, residuals.shape[1])
    limits = np.array([conformal_limit(np.abs(column), single) for column in residuals.T])
    # A coordinate without any error would make the volume 0, whatever the others.
    sides = np.maximum(2 * limits, np.finfo(float).tiny)
    return Region(
        covers=lambda new: np.asarray((np.abs(new) <= limits).all(axis=1)),
        size_mm=float(np.exp(np.log(sides).mean())),
    )


METHOD = RegionMethod("joint_bonferroni", "Bonferroni", is_exact=False, region=region, is_divided=True)
