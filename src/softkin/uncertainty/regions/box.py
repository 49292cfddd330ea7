"""Joint region: a box around the whole robot, with one limit for all coordinates, each in its own scale."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.conformal import conformal_limit, error_scale, joint_scores
from softkin.uncertainty.regions.spec import Region, RegionMethod


def region(train_residuals: Array, residuals: Array, markers: NDArray[np.intp], confidence_level: float) -> Region:  # noqa: ARG001
    """Split conformal prediction of the largest residual, in units of the typical errors on `train`."""
    scale = error_scale(np.abs(train_residuals))
    limit = conformal_limit(joint_scores(residuals, scale), confidence_level)
    return Region(
        covers=lambda new: np.asarray(joint_scores(new, scale) <= limit),
        size_mm=float(np.exp(np.log(2 * scale).mean()) * limit),
    )


METHOD = RegionMethod("joint_box", "Box", is_exact=True, region=region)
