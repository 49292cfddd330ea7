"""The baseline: an interval per coordinate, each at the error divided by the number of coordinates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.conformal import conformal_limit
from softkin.uncertainty.regions.spec import Region, RegionMethod


def region(train_residuals: Array, residuals: Array, markers: NDArray[np.intp], confidence_level: float) -> Region:  # noqa: ARG001
    """Covers all coordinates at least at the level, whatever they have to do with each other; mostly far above it."""
    n_coordinates = residuals.shape[1]
    single = 1 - (1 - confidence_level) / n_coordinates
    limits = np.array([conformal_limit(np.abs(column), single) for column in residuals.T])
    # A coordinate predicted without any error would make the volume 0 and hide all others.
    sides = np.maximum(2 * limits, np.finfo(float).tiny)
    return Region(
        covers=lambda new: np.asarray((np.abs(new) <= limits).all(axis=1)),
        size_mm=float(np.exp(np.log(sides).mean())),
    )


METHOD = RegionMethod("joint_bonferroni", "Bonferroni", is_exact=False, region=region)
