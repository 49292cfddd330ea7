"""What of a table is whole: rows and markers without gaps, by the key `missing` of the entry.

Trackers leave a cell empty where they lose a marker, or write zeros.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.data.readers.bad_rows import listed

REFUSE, DROP_ROWS, DROP_MARKERS = MISSING = ("refuse", "drop_rows", "drop_markers")
#: What is left out is called so in descriptions and data cards: rows in which a number is missing, markers that are
#: lost in some rows ({"columns": names, "rows": how many}), rows that have no partner in another file.
GAPS, LOST_MARKERS, UNJOINED = COUNTED = ("rows_with_gaps", "markers_with_gaps", "rows_without_partner")
#: What trackers and their users write in all coordinates of a marker that is lost.
FILLED = (0.0, -1.0, *(sign * float("9" * n) for n in (2, 3, 4, 5, 6) for sign in (1, -1)), -32768.0, 32767.0, 65535.0)
#: A marker there was lost where its other rows come no nearer, in one coordinate, than this share of its range.
FAR_FROM_ZERO = 0.1

logger = logging.getLogger("softkin")


@dataclass(frozen=True, slots=True)
class Whole:
    """The `rows` (numbers) and the coordinates (places within those of the entry) that are kept, and what is left out,
    by the names of `COUNTED`.
    """

    rows: NDArray[np.intp]
    coordinates: NDArray[np.intp]
    counts: Mapping[str, Any] = field(default_factory=dict)


def whole(
    commands: Array,
    positions: Array,
    names: Sequence[str],
    *,
    dimensions: int,
    missing: str,
    unjoined: NDArray[np.bool_] | None,
    place: Callable[[int], str],
) -> Whole:
    """What is left of a table without its gaps.

    Parameters:
        commands: (n_rows, n_commands), NaN in gaps.
        positions: (n_rows, n_coordinates), NaN in gaps; zeros of a lost marker become NaN in it.
        names: of the coordinates.
        dimensions: coordinates per marker.
        missing: `refuse`, `drop_rows` or `drop_markers`: then markers that are lost in some row are left out, and rows
            in which a command or every marker is missing.
        unjoined: rows (n_rows,) without a partner in another file, which are left out whatever `missing` is; None where
            there is one file.
        place: row number -> where the row stands in the file, for messages.

    Raises:
        DataError: a marker was lost and `missing` is `refuse`, or nothing is left.
    """
    is_joined = np.ones(len(commands), dtype=bool) if unjoined is None else ~unjoined
    counts: dict[str, Any] = {} if unjoined is None else {UNJOINED: int(unjoined.sum())}
    _find_zeros(positions, names, dimensions, missing, place)
    is_lost = np.asarray(np.isnan(positions).reshape(len(positions), -1, dimensions).any(axis=2))
    has_command = is_joined & ~np.isnan(commands).any(axis=1)
    kept = np.ones(is_lost.shape[1], dtype=bool)
    if missing == DROP_MARKERS:
        is_seen = has_command & ~is_lost.all(axis=1)
        n_lost = is_lost[is_seen].sum(axis=0)
        kept = n_lost == 0
        counts[LOST_MARKERS] = _lost_markers(n_lost, names, dimensions)
    is_whole = has_command & ~is_lost[:, kept].any(axis=1)
    if missing != REFUSE:
        counts[GAPS] = int((is_joined & ~is_whole).sum())
        if counts[GAPS]:
            logger.info("%d of %d rows are left out, since a number is missing", counts[GAPS], len(commands))
    if not is_whole.any():
        raise DataError("no row has all numbers", where="`missing`", fix="leave columns with gaps out of the entry")
    return Whole(np.flatnonzero(is_whole), np.flatnonzero(np.repeat(kept, dimensions)), counts)


def _lost_markers(n_lost: NDArray[np.intp], names: Sequence[str], dimensions: int) -> list[dict[str, Any]]:
    """The markers that are lost in some row, by their columns, and in how many rows `n_lost` (n_markers,)."""
    lost = [
        {"columns": list(names[marker * dimensions : (marker + 1) * dimensions]), "rows": count}
        for marker, count in enumerate(n_lost.tolist())
        if count
    ]
    for marker in lost:
        logger.info("left out: %s, missing in %d rows", ", ".join(marker["columns"]), marker["rows"])
    if len(lost) == len(n_lost):
        raise DataError(
            "every marker is lost in some row",
            where="`missing`",
            fix=f"write missing: {DROP_ROWS}, or leave the markers that are lost most often out of `positions`",
        )
    return lost


def lost_markers(positions: Array, dimensions: int) -> NDArray[np.bool_]:
    """Where a marker was lost and all its coordinates stand at one number of `FILLED` (n_rows, n_markers): its other
    rows do not come near. A marker that is there in most rows, or moves through it, was not lost.
    """
    points = positions.reshape(len(positions), -1, dimensions)
    is_lost = np.zeros(points.shape[:2], dtype=bool)
    for number in FILLED:
        is_lost |= _stands_far_off(points, number)
    return is_lost


def _stands_far_off(points: Array, number: float) -> NDArray[np.bool_]:
    """Where a marker stands at a number in all coordinates, and other rows of it do not come near (n_rows, n_markers);
    where it stands there in all rows it is not lost.
    """
    stands: NDArray[np.bool_] = np.asarray((points == number).all(axis=2))
    for marker in np.flatnonzero(stands.any(axis=0) & ~stands.all(axis=0)):
        seen = points[~stands[:, marker] & ~np.isnan(points[:, marker]).any(axis=1), marker]
        if len(seen) < stands[:, marker].sum():  # it stands there
            stands[:, marker] = False
            continue
        low, high = seen.min(axis=0) - number, seen.max(axis=0) - number
        is_far = np.maximum(low, -high).max() > FAR_FROM_ZERO * (high - low).max()
        if not is_far:
            stands[:, marker] = False
    return np.asarray(stands & ~stands.all(axis=0))


def _find_zeros(
    positions: Array, names: Sequence[str], dimensions: int, missing: str, place: Callable[[int], str]
) -> None:
    """Make NaN of the zeros, and their like, of lost markers, or refuse them."""
    is_zero = lost_markers(positions, dimensions)
    if not is_zero.any():
        return
    if missing == REFUSE:
        rows = np.flatnonzero(is_zero.any(axis=1))
        marker = int(np.argmax(is_zero[rows[0]]))
        number = positions[rows[0], marker * dimensions]
        count = f" ({listed('row', rows.tolist())})" if len(rows) > 1 else ""
        raise DataError(
            f"a marker at exactly {number:g}, far from where it is in other rows: its tracker lost it{count}",
            where=f"{place(int(rows[0]))}, columns {', '.join(names[marker * dimensions : (marker + 1) * dimensions])}",
            fix=f"delete the rows, or write missing: {DROP_ROWS} or missing: {DROP_MARKERS} into the entry",
        )
    positions[np.repeat(is_zero, dimensions, axis=1)] = np.nan
