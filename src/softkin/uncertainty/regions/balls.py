"""Joint region: a ball around every marker."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.conformal import conformal_limit, error_scale
from softkin.uncertainty.regions.spec import Region, RegionMethod, log_ball_volume


def marker_errors(residuals: Array, markers: NDArray[np.intp]) -> Array:
    """Euclidean error (n_rows, n_markers) in mm over the coordinates of each marker; `markers` (n_coordinates,)."""
    return np.column_stack([np.linalg.norm(residuals[:, markers == one], axis=1) for one in np.unique(markers)])


def region(
    train_residuals: Array,
    residuals: Array,
    markers: NDArray[np.intp],
    confidence_level: float,
    *,
    scaled: bool = False,
) -> Region:
    """Balls whose radius is a conformal limit of the largest Euclidean error of a pose.

    Parameters:
        train_residuals: residuals on `train` (n_train, n_coordinates) in mm, for the scale of each marker.
        residuals: residuals of the calibration set (n_calibration, n_coordinates) in mm.
        markers: marker of each coordinate (n_coordinates,).
        confidence_level: nominal level in (0, 1).
        scaled: whether errors are in units of the typical error of their marker on `train`.
    """
    dimensions = np.unique(markers, return_counts=True)[1].astype(float)
    scale = error_scale(marker_errors(train_residuals, markers)) if scaled else np.ones(len(dimensions))
    limit = conformal_limit((marker_errors(residuals, markers) / scale).max(axis=1), confidence_level)
    log_volume = (log_ball_volume(dimensions) + dimensions * np.log(scale)).sum()
    return Region(
        covers=lambda new: np.asarray((marker_errors(new, markers) / scale).max(axis=1) <= limit),
        size_mm=float(np.exp(log_volume / dimensions.sum()) * limit),
    )


METHOD = RegionMethod("joint_balls", "Balls of one radius", is_exact=True, region=region)
SCALED = RegionMethod(
    "joint_scaled_balls", "Balls, a radius per marker", is_exact=True, region=partial(region, scaled=True)
)
