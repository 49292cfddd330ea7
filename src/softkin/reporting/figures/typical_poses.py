"""Pick typical poses: rows that stand for equal parts of all rows, ordered by their error beside their interval."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array

#: Each pose is near the middle of a quarter of the rows; rows of nearly that rank stand for the quarter just as well.
QUANTILES, NEAR = (0.125, 0.375, 0.625, 0.875), 0.06


def relative_errors(true: Array, lower: Array, upper: Array) -> Array:
    """Error of each row (n_rows,) in half widths of its interval, in the worst coordinate: above 1 it is missed.

    `true`, `lower` and `upper` are (n_rows, n_coordinates) in mm; the error is that from the interval's middle. Of an
    interval that is infinite or has no width it is 0 where it holds the true position, and else infinite.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        ratios = np.abs(2 * true - lower - upper) / (upper - lower)
    is_covered = (lower <= true) & (true <= upper)
    is_ordinary = np.isfinite(ratios) & np.isfinite(upper - lower)
    return np.asarray(np.where(is_ordinary, ratios, np.where(is_covered, 0.0, np.inf)).max(axis=1))


def ranks(scores: Array) -> Array:
    """Share (n_rows,) of the other rows that have a smaller score."""
    return np.asarray(np.argsort(np.argsort(scores, kind="stable")) / max(len(scores) - 1, 1))


def typical_poses(scores: Array, positions: Array) -> NDArray[np.intp]:
    """Numbers (n_rows,) of the poses by score, from 1, and 0 for rows that are none.

    A pose is near one of `QUANTILES` of the relative errors `scores` (n_rows,), so that as many poses are missed as a
    rounded share of all rows. Of the rows whose rank is within `NEAR`, and which are missed or covered as that of
    nearest rank is, it is the one whose position (n_rows, 3) is farthest from the poses before it; the first from the
    mean.
    """
    poses: list[int] = []
    rank = ranks(scores)
    distance = np.linalg.norm(positions - positions.mean(axis=0), axis=1)
    for level in QUANTILES[: len(scores)]:
        gap = np.abs(rank - level)
        gap[poses] = np.inf
        is_alike = (scores > 1) == (scores[np.argmin(gap)] > 1)
        row = int(np.argmax(np.where((gap <= max(NEAR, gap.min())) & is_alike, distance, -1.0)))
        to_row = np.linalg.norm(positions - positions[row], axis=1)
        distance = np.minimum(distance, to_row) if poses else to_row
        poses.append(row)
    numbers = np.zeros(len(scores), dtype=np.intp)
    numbers[sorted(poses, key=lambda row: rank[row])] = np.arange(len(poses)) + 1
    return numbers
