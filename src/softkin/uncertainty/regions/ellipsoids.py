"""Joint region: an ellipsoid around every marker, shaped like its errors on `train`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.conformal import conformal_limit, error_scale
from softkin.uncertainty.regions.balls import log_ball_volume
from softkin.uncertainty.regions.spec import Region, RegionMethod

#: Added to the diagonal of a covariance as a share of its mean, so that it can be factorised.
RIDGE = 1e-9


def region(train_residuals: Array, residuals: Array, markers: NDArray[np.intp], confidence_level: float) -> Region:
    """Split conformal prediction of the largest Mahalanobis distance, in units of typical distances on `train`."""
    from scipy.linalg import solve_triangular

    factors = [_cholesky(train_residuals[:, markers == one]) for one in np.unique(markers)]

    def distances(rows: Array) -> Array:
        parts = [rows[:, markers == one] for one in np.unique(markers)]
        whitened = [solve_triangular(factor, part.T, lower=True) for factor, part in zip(factors, parts, strict=True)]
        return np.column_stack([np.linalg.norm(part, axis=0) for part in whitened])

    scale = error_scale(distances(train_residuals))
    limit = conformal_limit((distances(residuals) / scale).max(axis=1), confidence_level)
    dimensions = np.array([float(len(factor)) for factor in factors])
    log_shape = np.array([np.log(np.diag(factor)).sum() for factor in factors])
    log_volume = (log_ball_volume(dimensions) + log_shape + dimensions * np.log(scale)).sum()
    return Region(
        covers=lambda new: np.asarray((distances(new) / scale).max(axis=1) <= limit),
        size_mm=float(np.exp(log_volume / dimensions.sum()) * limit),
    )


def _cholesky(residuals: Array) -> Array:
    """Lower Cholesky factor of the second moments of residuals; that of a ball where they are 0."""
    moments = residuals.T @ residuals / len(residuals)
    mean = float(np.trace(moments)) / len(moments)
    if mean == 0:  # a model that repeats `train` exactly
        return np.eye(len(moments))
    return np.asarray(np.linalg.cholesky(moments + RIDGE * mean * np.eye(len(moments))))


METHOD = RegionMethod("joint_ellipsoids", "Ellipsoids", is_exact=True, region=region)
