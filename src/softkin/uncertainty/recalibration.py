"""Recalibration on a few labelled poses of a new session: the zero is shifted, widths are scaled, and a card says so.

Errors of the new session are those of the calibration set, up to a shift (the zero) and a scale. The zero is the mean
error of the labelled poses, shrunk towards the average session by how many they are; the scale is pooled with the
calibration set's, which counts as `PRIOR_POSES` poses; widths carry the zero's own uncertainty.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import norm, t

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.core.units import MM
from softkin.uncertainty.conformal import TINY, conformal_limits

#: How many labelled poses are taken: below, nothing is known of the session; above, fit the model again.
FEWEST_POSES, MOST_POSES = 1, 50
#: So many poses the scale of the calibration set counts as: chosen on simulated robots, benchmarks/recalibration.py.
PRIOR_POSES = 10.0
#: Poses whose errors scatter by more than this many times the calibration set's contradict it, or each other.
LARGEST_SCALE = 6.0


@dataclass(frozen=True, slots=True)
class Recalibration:
    """What a few labelled poses changed: `zero` (n_coordinates,) in mm is added to predictions; the calibration set's
    limits are multiplied by `stretch` (n_coordinates,), and by how much farther Student's t reaches than the normal
    distribution, as the scale is known from few poses. `n_poses` were labelled.
    """

    zero: Array
    stretch: Array
    n_poses: int
    unit: str = MM

    def half_widths(self, calibration_errors: Array, confidence_levels: Sequence[float]) -> Array:
        """Half-widths (n_levels, 1, n_coordinates) in mm, from the errors (n_calibration, n_coordinates)."""
        tail = (1 + np.asarray(confidence_levels)) / 2
        farther = t.ppf(tail, PRIOR_POSES + self.n_poses - 1) / norm.ppf(tail)
        limits = conformal_limits(np.abs(calibration_errors), confidence_levels)
        return np.asarray((farther[:, None] * limits)[:, None] * self.stretch)

    def card(self) -> str:
        """What changed, and what is promised now."""
        zero = ", ".join(f"{value:+.2f}" for value in self.zero)
        stretch = ", ".join(f"{value:.2f}" for value in self.stretch)
        return (
            f"Recalibrated on {self.n_poses} labelled poses of this session. The zero moved by {zero} {self.unit}; "
            f"intervals are {stretch} times as wide as those of the calibration set. Coverage is promised for this "
            "session as long as its errors are those of the calibration set up to a shift and a scale; recalibrate "
            "after the robot is switched on again, or when the alarm goes off."
        )


def recalibration(
    calibration_errors: Array,
    errors: Array,
    moving: NDArray[np.bool_],
    session_spread: Array | None,
    where: str,
    unit: str = MM,
) -> Recalibration:
    """What labelled poses of a new session tell.

    Parameters:
        calibration_errors: measured minus predicted positions (n_calibration, n_coordinates) in mm.
        errors: the same (n_poses, n_coordinates) of the labelled poses.
        moving: which coordinates (n_coordinates,) move; the others stay as they are.
        session_spread: standard deviation (n_coordinates,) in mm of zeros between known sessions; None where fewer than
            two are known: then the zero is not shrunk.
        where: the dataset, for messages.
        unit: of positions, for messages and the card.

    Raises:
        DataError: too few or too many poses, or they contradict each other.
    """
    n_poses = len(errors)
    if not FEWEST_POSES <= n_poses <= MOST_POSES:
        raise DataError(
            f"{n_poses} labelled poses, where {FEWEST_POSES} to {MOST_POSES} are taken",
            where=where,
            fix="label a few poses of the new session; with more, identify the robot again",
        )
    errors = np.where(moving, errors, 0.0)
    noise = np.where(moving, np.maximum(np.square(calibration_errors).mean(axis=0), TINY**2), 1.0)
    shrink = np.ones(errors.shape[1])
    if session_spread is not None:
        shrink = session_spread**2 / (session_spread**2 + noise / n_poses)
    scatter = np.square(errors - errors.mean(axis=0)).sum(axis=0) / noise
    scale = np.sqrt((PRIOR_POSES + scatter) / (PRIOR_POSES + n_poses - 1))
    if n_poses > 1 and (scatter / (n_poses - 1)).max() > LARGEST_SCALE**2:
        coordinate = int(np.argmax(scatter))
        farthest = int(np.argmax(np.abs(errors - np.median(errors, axis=0))[:, coordinate]))
        raise DataError(
            f"the labelled poses contradict each other: after a common shift they are still "
            f"{np.sqrt(scatter[coordinate] / (n_poses - 1)):.1f} times as far off as the calibration set",
            where=f"{where}, pose {farthest} is the farthest off",
            fix=f"check that each position belongs to its command, is in {unit}, and that no marker was lost",
        )
    return Recalibration(shrink * errors.mean(axis=0), scale * np.sqrt(1 + shrink / n_poses), n_poses, unit)
