"""Check for swapped markers: rows whose distances between markers an exchange of labels would mend.

A tracker that loses two markers and finds them again may give each the other's name. Distances between the markers of a
robot vary with its bending, but within limits that most rows show; a row beyond them that an exchange of two markers,
or a few exchanges, brings back within has swapped labels. The key `relabel` of the entry mends such rows.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import chunks
from softkin.core.samples import TRAIN, Array, Samples
from softkin.data.audit.findings import WARNING, CheckResult, counted, finding_of_rows

#: A distance is off where it differs from the median by so many robust standard deviations. An exchange mends a row
#: where it leaves at most the second number, and less than this share of what all distances were off by.
OFF, MENDED, MENDED_SHARE = 8.0, 5.0, 0.3
#: No distance is known better than to this share of it, and of the whole robot.
LEAST_SCALE, LEAST_SHARE = 0.01, 1e-3
MAX_EXCHANGES, MAX_MARKERS, FEWEST_ROWS = 3, 24, 20
Orders = NDArray[np.int64]


def check(samples: Mapping[str, Samples]) -> CheckResult:
    """At most one finding, on all subsets."""
    n_markers = samples[TRAIN].positions.shape[1] // 3
    if not 3 <= n_markers <= MAX_MARKERS or len(samples[TRAIN]) < FEWEST_ROWS:
        return CheckResult((), {"not_measured": f"3 to {MAX_MARKERS} markers and {FEWEST_ROWS} rows are needed"})
    orders = {subset: orders_of(rows.positions, samples[TRAIN].positions) for subset, rows in samples.items()}
    marked = {subset: _is_swapped(order) for subset, order in orders.items()}
    numbers = {"rows": {subset: int(mask.sum()) for subset, mask in marked.items()}}
    if not any(numbers["rows"].values()):
        return CheckResult((), numbers)
    moved = np.concatenate([order[marked[subset]] for subset, order in orders.items()]) != np.arange(n_markers)
    names = ", ".join(f"m{place + 1}" for place in np.flatnonzero(moved.any(axis=0)))
    finding = finding_of_rows(
        "swapped_markers",
        WARNING,
        marked,
        f"{counted(sum(numbers['rows'].values()), 'row')} have distances between markers that an exchange of labels "
        f"would mend, among {names}.",
        "The tracker mixed up its markers there, and a model learns the mean of both. relabel: true in the entry mends "
        "these rows in every subset and counts them.",
    )
    return CheckResult((finding,), numbers)


def relabelled(samples: Mapping[str, Samples]) -> tuple[dict[str, Samples], dict[str, int]]:
    """`samples` with the markers of swapped rows in order, by what `train` shows of distances, and how many rows of
    each subset that were.
    """
    train, counts, mended = samples[TRAIN].positions, {}, {}
    for subset, rows in samples.items():
        order = orders_of(rows.positions, train)
        points = np.take_along_axis(rows.positions.reshape(len(rows), -1, 3), order[:, :, None], axis=1)
        counts[subset] = int(_is_swapped(order).sum())
        mended[subset] = Samples(rows.commands, points.reshape(len(rows), -1), rows.recording)
    return mended, counts


def orders_of(positions: Array, train: Array) -> Orders:
    """Which marker (n_rows, n_markers) of each row of `positions` (n_rows, n_coordinates) stands where each should, by
    the distances of `train`; that of the file where nothing is to be mended.
    """
    n_markers = train.shape[1] // 3
    pairs = np.array(list(combinations(range(n_markers), 2)), dtype=np.int64).reshape(-1, 2)
    known = _distances(train, pairs)
    middle = np.median(known, axis=0)
    spread = 1.4826 * np.median(np.abs(known - middle), axis=0)
    scale = np.maximum(spread, np.maximum(LEAST_SCALE * middle, LEAST_SHARE * middle.max()))
    result = np.tile(np.arange(n_markers), (len(positions), 1))
    if not scale.min() > 0:
        return result
    for part in chunks(len(positions)):
        before = np.abs(_distances(positions[part], pairs) - middle) / scale
        rows = part.start + np.flatnonzero(before.max(axis=1) > OFF)
        if len(rows):
            orders, after = _mended(positions[rows].reshape(len(rows), n_markers, 3), pairs, middle, scale)
            good = after.max(axis=1) <= MENDED
            good &= after.sum(axis=1) < MENDED_SHARE * before[rows - part.start].sum(axis=1)
            result[rows[good]] = orders[good]
    return result


def _mended(points: Array, pairs: Orders, middle: Array, scale: Array) -> tuple[Orders, Array]:
    """The order (n_rows, n_markers) of markers after the best exchanges of two, and how far distances are off then."""
    table = np.linalg.norm(points[:, :, None] - points[:, None], axis=3)
    rows = np.arange(len(points))[:, None]

    def off(orders: Orders) -> Array:
        found = table[rows, orders[:, pairs[:, 0]], orders[:, pairs[:, 1]]]
        return np.asarray(np.abs(found - middle) / scale)

    best = np.tile(np.arange(points.shape[1]), (len(points), 1))
    misses = off(best)
    for _ in range(MAX_EXCHANGES):
        start, improved = best, misses.sum(axis=1)
        for one, other in pairs:
            tried = start.copy()
            tried[:, [one, other]] = start[:, [other, one]]
            misses_then = off(tried)
            better = misses_then.sum(axis=1) < improved
            best = np.where(better[:, None], tried, best)
            misses = np.where(better[:, None], misses_then, misses)
            improved = np.where(better, misses_then.sum(axis=1), improved)
    return best, misses


def _distances(positions: Array, pairs: Orders) -> Array:
    """Distances (n_rows, n_pairs) between markers, mm."""
    points = positions.reshape(len(positions), -1, 3)
    return np.asarray(np.linalg.norm(points[:, pairs[:, 0]] - points[:, pairs[:, 1]], axis=2))


def _is_swapped(orders: Orders) -> NDArray[np.bool_]:
    return np.asarray((orders != np.arange(orders.shape[1])).any(axis=1))
