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
#: multiplied by after one that is none; and the largest. Up to `RAISED_TO` steps are hardly shortened by it.
DAMPING, EASED, RAISED, MOST_DAMPING = 1e-9, 10.0, 30.0, 1e6
LEAST_DAMPING, RAISED_TO = 1e-12, 1e-4
#: A step that leaves such a share of the distance is a quick one.
QUICK = 0.1


@dataclass(frozen=True)
class Problems:
    """For each row a point (n_free,), between 0 and 1, of which `function` (n_rows, n_free) -> (n_rows, n_residuals)
    is nearest to its target.

    Parameters:
        function: taken at many points at once; points of all problems are handed to it together.
        targets: (n_problems, n_residuals), in the units of the function.
        near: points (n_problems, n_free) that solutions are held near, with `weights` (n_problems,).
        enough: a distance to the target of which nothing is to be gained below; a problem ends there, and where a step
            brings it no nearer than by as much.
        caution: the least damping (n_problems,): where commands are redundant it keeps each step near the last point.
    """

    function: Callable[[Array], Array]
    targets: Array
    near: Array
    weights: Array
    enough: float
    caution: Array

    def of(self, rows: NDArray[np.intp]) -> Problems:
        """Some of the problems."""
        parts = {name: getattr(self, name)[rows] for name in ("targets", "near", "weights", "caution")}
        return replace(self, **parts)

    def residuals(self, points: Array, rows: NDArray[np.intp]) -> Array:
        """What is missing (n_rows, n_residuals) to the targets of these problems at points (n_rows, n_free)."""
        return self.function(points) - self.targets[rows]

    def slopes(self, points: Array, residuals: Array, rows: NDArray[np.intp]) -> Array:
        """Derivatives (n_rows, n_residuals, n_free) of `residuals` at points (n_rows, n_free) of these problems, by
        finite differences that stay between the bounds.
        """
        n_rows, n_free = points.shape
        steps = np.where(points + STEP <= 1, STEP, -STEP)
        beside = (points[:, None] + steps[..., None] * np.eye(n_free)).reshape(-1, n_free)
        changed = (
            self.residuals(beside, rows.repeat(n_free)).reshape(n_rows, n_free, residuals.shape[1]) - residuals[:, None]
        )
        return np.asarray((changed / steps[..., None]).transpose(0, 2, 1))

    def solved(self, starts: Array, at_starts: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Local solutions (n_problems, n_free) and their residuals (n_problems, n_residuals), from `starts`, where
        residuals and derivatives are `at_starts`.

        By Levenberg's and Marquardt's damped steps, in which points at a bound that cost drives beyond stay there
        (Bertsekas 1982). A step that leaves a tenth of the distance or less mends the derivatives by what it found
        (Broyden 1965); after others they are worked out anew.
        """
        points = np.array(starts)
        rows = np.arange(len(points))
        known = self.residuals(points, rows) if at_starts is None else at_starts[0].copy()
        slopes = self.slopes(points, known, rows) if at_starts is None else at_starts[1].copy()
        damping, residuals = np.maximum(DAMPING, self.caution), known.copy()
        for _ in range(MOST_EVALUATIONS - 1):
            if not len(rows):
                break
            here, pull, caution = points[rows], self.weights[rows] ** 2, self.caution[rows]
            moved = here - self.near[rows]
            cost = _squares(known) + pull * _squares(moved)
            stepped = _stepped(here, known, slopes, pull, moved, damping)
            there = self.residuals(stepped, rows)
            changed, before = there - known, _squares(known)
            gain = cost - _squares(there) - pull * _squares(stepped - self.near[rows])
            is_better = gain > 0
            points[rows[is_better]], known[is_better] = stepped[is_better], there[is_better]
            residuals[rows] = known
            ends = (np.abs(stepped - here).max(axis=1) <= TOLERANCE) | (damping > MOST_DAMPING)
            # Cost is a square: it falls by 2 sqrt(cost) times what the distance does.
            least = np.where(damping <= RAISED_TO, 2 * np.sqrt(cost) * self.enough, 0.0)
            ends |= is_better & (gain <= np.maximum(TOLERANCE * cost, least))
            ends |= np.sqrt(_squares(known)) <= np.where(pull > 0, 0.0, self.enough)
            eased = np.maximum(damping / EASED, np.maximum(LEAST_DAMPING, caution))
            damping = np.where(is_better, eased, np.maximum(damping * RAISED, RAISED_TO))
            asked, is_quick = is_better & ~ends, _squares(there) <= QUICK**2 * before
            mended = asked & is_quick
            slopes[mended] = _mended(slopes[mended], (stepped - here)[mended], changed[mended])
            asked &= ~is_quick
            if asked.any():
                slopes[asked] = self.slopes(points[rows[asked]], known[asked], rows[asked])
            rows, known, slopes, damping = rows[~ends], known[~ends], slopes[~ends], damping[~ends]
        return points, residuals


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


def _mended(slopes: Array, moved: Array, changed: Array) -> Array:
    """Derivatives (n_rows, n_residuals, n_free) of least change that tell how residuals `changed` (n_rows, n_residuals)
    where points `moved` (n_rows, n_free).
    """
    off = changed - np.einsum("ijk,ik->ij", slopes, moved)
    return np.asarray(slopes + off[:, :, None] * (moved / _squares(moved)[:, None])[:, None])


def _squares(rows: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", rows, rows))
