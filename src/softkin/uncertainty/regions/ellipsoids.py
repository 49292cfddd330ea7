"""Joint region: an ellipsoid around every marker, shaped like its errors on `train`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.conformal import error_scale
from softkin.uncertainty.regions.spec import Region, RegionMethod, log_ball_volume, of_shape

#: Added to the diagonal of a covariance as a share of its mean, so that it can be factorised.
RIDGE = 1e-9
#: A residual counts at most as so many typical errors of its coordinate: gross errors are not of the shape.
CAP = 3.0


@dataclass(frozen=True)
class Ellipsoids:
    """An ellipsoid around each marker: `factors`, a lower Cholesky factor in mm for each, at size 1; `markers`
    (n_coordinates,) as of the residuals, in blocks.
    """

    markers: NDArray[np.intp]
    factors: tuple[Array, ...]
    kind: ClassVar[str] = "ellipsoids"

    @property
    def unit_size_mm(self) -> float:
        """Side of the cube of the volume of all ellipsoids together at size 1."""
        dimensions = np.array([float(len(factor)) for factor in self.factors])
        log_shape = np.array([np.log(np.diag(factor)).sum() for factor in self.factors])
        return float(np.exp((log_ball_volume(dimensions) + log_shape).sum() / dimensions.sum()))

    @property
    def half_widths(self) -> Array:
        """Half the extent (n_coordinates,) in mm of the ellipsoids of size 1 along each axis."""
        return np.sqrt(np.diag(self.matrix))

    @cached_property
    def matrix(self) -> Array:
        """Second moments in blocks (n_coordinates, n_coordinates) in mm2, at size 1."""
        from scipy.linalg import block_diag

        return np.asarray(block_diag(*(factor @ factor.T for factor in self.factors)))

    def scores(self, residuals: Array) -> Array:
        """The largest Mahalanobis distance of a marker, (n_rows,)."""
        return np.asarray(_distances(residuals, self.markers, self.factors).max(axis=1))


def shape(train_residuals: Array, markers: NDArray[np.intp], cap: float = CAP) -> Ellipsoids:
    """Shaped like the second moments of the residuals on `train`, gross ones capped, and so large that each holds nine
    in ten of them at size 1.
    """
    largest = cap * error_scale(np.abs(train_residuals))
    capped = np.clip(train_residuals, -largest, largest)
    factors = [_cholesky(capped[:, markers == one]) for one in np.unique(markers)]
    scale = error_scale(_distances(train_residuals, markers, factors))
    return Ellipsoids(markers, tuple(size * factor for size, factor in zip(scale, factors, strict=True)))


def region(train_residuals: Array, residuals: Array, markers: NDArray[np.intp], confidence_level: float) -> Region:
    """Split conformal prediction of the largest Mahalanobis distance, in units of typical distances on `train`."""
    return of_shape(shape(train_residuals, markers), residuals, confidence_level)


def _distances(residuals: Array, markers: NDArray[np.intp], factors: Sequence[Array]) -> Array:
    """Mahalanobis distance of each marker (n_rows, n_markers), of residuals (n_rows, n_coordinates) in mm."""
    from scipy.linalg import solve_triangular

    parts = [residuals[:, markers == one] for one in np.unique(markers)]
    whitened = [solve_triangular(factor, part.T, lower=True) for factor, part in zip(factors, parts, strict=True)]
    return np.column_stack([np.linalg.norm(part, axis=0) for part in whitened])


def _cholesky(residuals: Array) -> Array:
    """Lower Cholesky factor of the second moments of residuals; that of a ball where they are 0."""
    moments = residuals.T @ residuals / len(residuals)
    mean = float(np.trace(moments)) / len(moments)
    if mean == 0:  # a model that repeats `train` exactly
        return np.eye(len(moments))
    return np.asarray(np.linalg.cholesky(moments + RIDGE * mean * np.eye(len(moments))))


METHOD = RegionMethod("joint_ellipsoids", "Ellipsoids", is_exact=True, region=region)
