"""The order of markers: which rows of a table have swapped labels, by the distances between markers, and their mending.

A tracker that loses two markers and finds them again may give each the other's name. Distances between the markers of a
robot vary with its bending, but within limits that most rows show; a row beyond them that an exchange of two markers,
or a few exchanges, brings back within has swapped labels. Where several orders do, as those of an evenly marked arm and
of its reverse, the one counts whose markers lie nearest to where they usually are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import chunks
from softkin.core.samples import TRAIN, Array, Samples

#: A distance is off where it differs from the median by so many robust standard deviations. An exchange mends a row
#: where it leaves at most the second number, and less than this share of what all distances were off by.
OFF, MENDED, MENDED_SHARE = 8.0, 5.0, 0.3
#: No distance is known better than to this share of it, and of the whole robot.
LEAST_SCALE, LEAST_SHARE = 0.01, 1e-3
MAX_EXCHANGES = 3
#: Of two markers an exchange changes no distance.
FEWEST_MARKERS = 3
#: What the numbers of mended rows are called in descriptions and data cards.
RELABELLED = "relabelled_rows"
Orders = NDArray[np.int64]


def relabelled(samples: Mapping[str, Samples]) -> tuple[dict[str, Samples], dict[str, int]]:
    """`samples` with the markers of swapped rows in order, by what `train` shows of distances, and how many rows of
    each subset that were.
    """
    train, counts, mended = samples[TRAIN].positions, {}, {}
    for subset, rows in samples.items():
        order = orders_of(rows.positions, train)
        points = np.take_along_axis(rows.positions.reshape(len(rows), -1, 3), order[:, :, None], axis=1)
        counts[subset] = int(is_swapped(order).sum())
        mended[subset] = replace(rows, positions=points.reshape(len(rows), -1))
    return mended, counts


def orders_of(positions: Array, train: Array) -> Orders:
    """Which marker (n_rows, n_markers) of each row of `positions` (n_rows, n_coordinates) stands where each should, by
    the distances of `train`; that of the file where nothing is to be mended.
    """
    n_markers = train.shape[1] // 3
    result = np.tile(np.arange(n_markers), (len(positions), 1))
    if n_markers < FEWEST_MARKERS:
        return result
    pairs = np.array(list(combinations(range(n_markers), 2)), dtype=np.int64).reshape(-1, 2)
    known = _distances(train, pairs)
    middle = np.median(known, axis=0)
    spread = 1.4826 * np.median(np.abs(known - middle), axis=0)
    scale = np.maximum(spread, np.maximum(LEAST_SCALE * middle, LEAST_SHARE * middle.max()))
    usual = _usual_places(train.reshape(len(train), n_markers, 3))
    if not scale.min() > 0:
        return result
    for part in chunks(len(positions)):
        before = np.abs(_distances(positions[part], pairs) - middle) / scale
        rows = part.start + np.flatnonzero(before.max(axis=1) > OFF)
        if len(rows):
            orders, after = _mended(positions[rows].reshape(len(rows), n_markers, 3), pairs, middle, scale, usual)
            good = after.max(axis=1) <= MENDED
            good &= after.sum(axis=1) < MENDED_SHARE * before[rows - part.start].sum(axis=1)
            result[rows[good]] = orders[good]
    return result


def _usual_places(points: Array) -> tuple[Array, Array]:
    """Median (n_markers, 3) of each marker of `points` (n_rows, n_markers, 3), and its typical distance from there."""
    middle = np.median(points, axis=0)
    away = np.median(np.linalg.norm(points - middle, axis=2), axis=0)
    return middle, np.maximum(away, np.finfo(float).tiny + LEAST_SCALE * away.max())


def _mended(
    points: Array, pairs: Orders, middle: Array, scale: Array, usual: tuple[Array, Array]
) -> tuple[Orders, Array]:
    """The order (n_rows, n_markers) of markers after the best exchanges of two, and how far distances are off then."""
    n_rows, n_markers = points.shape[:2]
    table = np.linalg.norm(points[:, :, None] - points[:, None], axis=3)
    away = np.linalg.norm(points[:, :, None] - usual[0], axis=3) / usual[1]
    rows = np.arange(n_rows)[:, None]

    def off(orders: Orders) -> Array:
        found = table[rows, orders[:, pairs[:, 0]], orders[:, pairs[:, 1]]]
        return np.asarray(np.abs(found - middle) / scale)

    def cost(orders: Orders) -> Array:
        places = away[rows, orders, np.arange(n_markers)]
        return np.asarray(off(orders).sum(axis=1) + places.sum(axis=1))

    best = np.tile(np.arange(n_markers), (n_rows, 1))
    lowest = cost(best)
    for _ in range(MAX_EXCHANGES):
        start = best
        for one, other in pairs:
            tried = start.copy()
            tried[:, [one, other]] = start[:, [other, one]]
            of_tried = cost(tried)
            best = np.where((of_tried < lowest)[:, None], tried, best)
            lowest = np.minimum(lowest, of_tried)
    return best, off(best)


def _distances(positions: Array, pairs: Orders) -> Array:
    """Distances (n_rows, n_pairs) between markers, mm."""
    points = positions.reshape(len(positions), -1, 3)
    return np.asarray(np.linalg.norm(points[:, pairs[:, 0]] - points[:, pairs[:, 1]], axis=2))


def is_swapped(orders: Orders) -> NDArray[np.bool_]:
    """Mask (n_rows,) of the rows whose order (n_rows, n_markers) is not that of the file."""
    return np.asarray((orders != np.arange(orders.shape[1])).any(axis=1))
