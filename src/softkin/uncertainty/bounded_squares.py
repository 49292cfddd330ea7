"""Nonlinear least squares between bounds, of many small problems at once: one call of the model serves them all.

SciPy's `least_squares` takes one problem at a time, and for problems of a few numbers nearly all its time is its own
arithmetic around calls of the model for three rows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array

#: Step of finite differences: the square root of the precision of doubles is 1.5e-8.
STEP = 1e-6
#: A problem ends when a step is this small, or cost falls by this share; and after so many evaluations.
TOLERANCE, MOST_EVALUATIONS = 1e-7, 60
#: Damping at the start, as a share of the largest curvature; what it is divided by after a step that is good, and
#: multiplied by after one that is none; and the largest.
DAMPING, EASED, RAISED, MOST_DAMPING = 1e-9, 10.0, 30.0, 1e6
LEAST_DAMPING, RAISED_TO = 1e-12, 1e-4


@dataclass(frozen=True)
class Problems:
    """For each row a point (n_free,), between 0 and 1, of which `function` (n_rows, n_free) -> (n_rows, n_residuals)
    is nearest to its target.

    Parameters:
        function: taken at many points at once; points of all problems are handed to it together.
        targets: (n_problems, n_residuals), in the units of the function.
        near: points (n_problems, n_free) that solutions are held near, with `weights` (n_problems,).
        enough: a distance to the target of which nothing is to be gained below; a problem ends there.
    """

    function: Callable[[Array], Array]
    targets: Array
    near: Array
    weights: Array
    enough: float

    def of(self, rows: NDArray[np.intp], near: Array) -> Problems:
        """Some of the problems, held near other points (n_problems, n_free)."""
        return replace(self, targets=self.targets[rows], near=near[rows], weights=self.weights[rows])

    def with_jacobian(self, points: Array, rows: NDArray[np.intp]) -> tuple[Array, Array]:
        """Residuals (n_rows, n_residuals) and their derivatives (n_rows, n_residuals, n_free) at points (n_rows,
        n_free) of these problems, by finite differences that stay between the bounds.
        """
        n_rows, n_free = points.shape
        steps = np.where(points + STEP <= 1, STEP, -STEP)
        beside = points[:, None] + steps[..., None] * np.eye(n_free)
        values = self.function(np.concatenate([points[:, None], beside], axis=1).reshape(-1, n_free))
        values = values.reshape(n_rows, n_free + 1, -1)
        slopes = (values[:, 1:] - values[:, :1]) / steps[..., None]
        return values[:, 0] - self.targets[rows], slopes.transpose(0, 2, 1)

    def solved(self, starts: Array, at_starts: tuple[Array, Array] | None = None) -> Array:
        """Local solutions (n_problems, n_free) from `starts`, where residuals and derivatives are `at_starts`.

        By Levenberg's and Marquardt's damped steps, in which points at a bound that cost drives beyond stay there
        (Bertsekas 1982).
        """
        points = np.array(starts)
        rows = np.arange(len(points))
        if not len(points):
            return points
        known, slopes = at_starts or self.with_jacobian(points, rows)
        damping = np.full(len(points), DAMPING)
        for _ in range(MOST_EVALUATIONS - 1):
            here, pull = points[rows], self.weights[rows] ** 2
            moved = here - self.near[rows]
            cost = _squares(known) + pull * _squares(moved)
            stepped = _stepped(here, known, slopes, pull, moved, damping)
            there, there_slopes = self.with_jacobian(stepped, rows)
            gain = cost - _squares(there) - pull * _squares(stepped - self.near[rows])
            is_better = gain > 0
            points[rows[is_better]] = stepped[is_better]
            known[is_better], slopes[is_better] = there[is_better], there_slopes[is_better]
            is_small = np.abs(stepped - here).max(axis=1) <= TOLERANCE
            ends = is_small | (is_better & (gain <= TOLERANCE * cost)) | (damping > MOST_DAMPING)
            ends |= np.sqrt(_squares(known)) <= np.where(pull > 0, 0.0, self.enough)
            eased, raised = damping / EASED, np.maximum(damping * RAISED, RAISED_TO)
            damping = np.where(is_better, np.maximum(eased, LEAST_DAMPING), raised)
            rows, known, slopes, damping = rows[~ends], known[~ends], slopes[~ends], damping[~ends]
            if not len(rows):
                break
        return points


def _stepped(points: Array, known: Array, slopes: Array, pull: Array, moved: Array, damping: Array) -> Array:
    """Points (n_rows, n_free) after a damped step, between the bounds."""
    n_free = points.shape[1]
    slope = np.einsum("ijk,ij->ik", slopes, known) + pull[:, None] * moved
    curvature = np.einsum("ijk,ijl->ikl", slopes, slopes) + pull[:, None, None] * np.eye(n_free)
    largest = np.maximum(np.einsum("ikk->ik", curvature).max(axis=1), np.finfo(float).tiny ** 0.5)
    is_held = ((points <= 0) & (slope > 0)) | ((points >= 1) & (slope < 0))
    free = ~is_held
    curvature = curvature * (free[:, :, None] & free[:, None])
    curvature += (damping * largest)[:, None, None] * np.eye(n_free) + is_held[:, :, None] * np.eye(n_free)
    step = np.linalg.solve(curvature, np.where(free, slope, 0.0)[..., None])[..., 0]
    return np.clip(points - step, 0.0, 1.0)


def _squares(rows: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", rows, rows))
