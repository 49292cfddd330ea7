"""Where a robot's base stands and which way it points: declared, or estimated from `train`."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation
from sklearn.preprocessing import StandardScaler

from softkin.core.geometry.constant_curvature import from_arcs, to_arcs
from softkin.core.rows import Indices, sampled_rows
from softkin.core.samples import CONSTANT_RANGE_MM, Array
from softkin.core.smooth_fit import fit_smoothly

#: Rows that outliers are sought in, drawn with a fixed seed: a million rows would stand in memory several times.
MAX_ROWS_SAMPLED = 10_000
#: Rows that a frame is estimated from, evenly spread over those sorted by how far they are bent aside.
MAX_ROWS = 300
#: Residuals are divided by this share of the robot's extent: larger ones weigh less, as those of outliers.
TYPICAL_RESIDUAL = 0.01
#: Rows this many robust standard deviations off a smooth fit are outliers and left out.
OUTLIER = 8.0
#: How far below the highest marker the base may be, in units of how far markers go aside: where the search starts.
STARTS = (0.5, 1.0, 2.0, 4.0)
REFINED_STARTS = 4
#: An axis less than this (rad) off z counts as z: the squares of such numbers may underflow.
PARALLEL = 1e-15
#: A marker stands at the base where it moves by at most these shares of what the marker that moves most does, and
#: the one that moves least after it: along an evenly marked arm each moves by a quarter of the next or more.
HARDLY, HARDLY_BESIDE = 0.01, 0.05
#: An estimated base is out of reach where it is farther from the nearest marker than the robot is long; of a single
#: marker no length is known, but no robot is so many times as long as its tip moves.
LENGTHS_OF_ONE_MARKER = 10.0
#: Estimates that are cached: a study fits all its trials to the same few parts of `train`.
MAX_CACHED = 64


#: An array of doubles as something hashable: its bytes and its shape.
_Key = tuple[bytes, tuple[int, ...]]


@dataclass(frozen=True, slots=True)
class BaseFrame:
    """`origin` (3,) in mm and `axis` (3,), the unit vector along which the straight robot leaves its base.

    `refused_mm`: how far from the nearest marker the base was estimated, where that is out of reach and not used.
    """

    origin: Array
    axis: Array
    refused_mm: float | None = None

    def to_base(self, points: Array) -> Array:
        """Points (n_rows, n_markers, 3) in the data's frame -> the frame of the base, whose z is the axis."""
        return np.asarray((points - self.origin) @ self.axes())

    def from_base(self, points: Array) -> Array:
        """The inverse of `to_base`."""
        return np.asarray(points @ self.axes().T + self.origin)

    def axes(self) -> Array:
        """Matrix (3, 3) from the data's frame to that of the base, for rows: the smallest turn of z into the axis."""
        return np.asarray(self._rotation().as_matrix())

    def _rotation(self) -> Rotation:
        cross, cosine = np.cross([0.0, 0.0, 1.0], self.axis), self.axis[2]
        sine = float(np.linalg.norm(cross))
        if sine < PARALLEL:
            return Rotation.identity() if cosine > 0 else Rotation.from_rotvec([np.pi, 0, 0])
        return Rotation.from_rotvec(cross / sine * np.arctan2(sine, cosine))


def base_frame(commands: Array, points: Array, declared: Mapping[str, Any] | None = None) -> BaseFrame:
    """The frame of a robot's base, from its commands (n_rows, n_commands) and markers `points` (n_rows, n_markers, 3)
    in mm.

    `declared` may hold `origin` (mm; None where a coordinate is not known) and `axis`. What it does not hold is
    estimated: the origin is a marker at the base, if there is one; else origin and axis are those for which arcs that
    are linear in the commands come closest to the markers, by robust least squares. An origin that is farther from the
    markers than the robot is long is not used: it is brought as near as that.
    """
    declared = declared or {}
    still = markers_at_the_base(points)
    origin = np.array(declared.get("origin") or [None] * 3, dtype=np.float64)
    if np.isnan(origin).all() and still.any():
        at_base = points[:, np.flatnonzero(still)[0]]
        origin = at_base[0] if np.ptp(at_base, axis=0).max() <= CONSTANT_RANGE_MM else np.median(at_base, axis=0)
    axis = _unit(declared["axis"]) if declared.get("axis") else None
    if axis is not None and not np.isnan(origin).any():
        return BaseFrame(origin, axis)
    drawn = sampled_rows(len(commands), MAX_ROWS_SAMPLED, seed=0)
    commands, moving = commands[drawn], points[np.ix_(drawn, ~still)]
    rows = _sample_without_outliers(commands, moving)
    arrays = np.asarray(commands[rows], dtype=np.float64), np.asarray(moving[rows], dtype=np.float64)
    frame = _cached(*((array.tobytes(), array.shape) for array in arrays), origin.tobytes(), _bytes(axis))
    return _within_reach(frame, arrays[1]) if np.isnan(origin).any() else frame


def markers_at_the_base(points: Array) -> NDArray[np.bool_]:
    """Mask (n_markers,) of the markers of `points` (n_rows, n_markers, 3) that never move; where there are none, of the
    one that hardly moves, if there is one.
    """
    still = np.asarray(np.ptp(points, axis=0).max(axis=1) <= CONSTANT_RANGE_MM)
    if still.any() or len(still) < 2:
        return still
    moved = np.median(np.linalg.norm(points - np.median(points, axis=0), axis=2), axis=0)
    least, beside = np.argsort(moved, kind="stable")[:2]
    still[least] = moved[least] <= min(HARDLY * moved.max(), HARDLY_BESIDE * moved[beside])
    return still


def _within_reach(frame: BaseFrame, points: Array) -> BaseFrame:
    """The frame, or one whose origin is as far from the nearest of `points` (n_rows, n_markers, 3) as the robot is long
    where it was estimated farther away.
    """
    n_rows, n_markers = points.shape[:2]
    if n_markers > 1:
        length = max(float(np.linalg.norm(points - points[:, [place]], axis=2).max()) for place in range(n_markers))
    else:
        length = LENGTHS_OF_ONE_MARKER * float(np.linalg.norm(np.ptp(points.reshape(n_rows, 3), axis=0)))
    distances = np.linalg.norm(points - frame.origin, axis=2)
    nearest = float(distances.min())
    if nearest <= length:
        return frame
    row, marker = np.unravel_index(int(distances.argmin()), distances.shape)
    middle = points[row, marker]
    return BaseFrame(middle + (frame.origin - middle) * (length / nearest), frame.axis, refused_mm=nearest)


def _sample_without_outliers(commands: Array, points: Array) -> Indices:
    """Row numbers without outliers, about `MAX_ROWS`, evenly spread from the middle to those bent farthest."""
    positions = points.reshape(len(points), -1)
    fit = fit_smoothly(commands, positions, np.arange(len(commands)))
    good = np.abs(fit.residuals(commands, positions)) <= fit.limits(commands, OUTLIER)
    rows = np.flatnonzero(good.all(axis=1)) if fit.degree else np.arange(len(commands))
    aside = np.linalg.norm(points[rows, -1] - np.median(points[rows, -1], axis=0), axis=1)
    return rows[np.argsort(aside, kind="stable")][:: max(1, len(rows) // MAX_ROWS)]


@lru_cache(MAX_CACHED)
def _cached(commands: _Key, points: _Key, origin: bytes, axis: bytes | None) -> BaseFrame:
    """`_estimated`, called with the bytes and shapes of its arguments."""
    of_commands, of_points = (np.frombuffer(content).reshape(shape) for content, shape in (commands, points))
    return _estimated(of_commands, of_points, np.frombuffer(origin), None if axis is None else np.frombuffer(axis))


def _estimated(commands: Array, points: Array, origin: Array, axis: Array | None) -> BaseFrame:
    """The frame by robust least squares; `origin` is NaN where it is to be estimated, `axis` is None."""
    terms = np.column_stack([np.ones(len(commands)), StandardScaler().fit_transform(commands)])
    solve = np.linalg.pinv(terms)
    flat = points.reshape(-1, 3)
    # A planar robot's base lies in its plane.
    spread_out = np.ptp(flat, axis=0) > CONSTANT_RANGE_MM
    moves = np.isnan(origin) & spread_out
    within = np.eye(3)[spread_out]
    extent = float(np.linalg.norm(np.ptp(flat, axis=0)))

    def moved(start: BaseFrame, values: Array) -> BaseFrame:
        """The frame that lies `values` from a start: shares of the extent for the origin, radians for the axis."""
        new = start.origin.copy()
        new[moves] += extent * values[: moves.sum()]
        if axis is not None:
            return BaseFrame(new, axis)
        sideways = np.linalg.svd((within @ start.axis)[None, :])[2][1:] @ within
        return BaseFrame(new, _unit(start.axis + values[moves.sum() :] @ sideways))

    def residuals(values: Array, start: BaseFrame) -> Array:
        frame = moved(start, values)
        fitted = (terms @ (solve @ to_arcs(frame.to_base(points)).reshape(len(points), -1))).reshape(points.shape)
        return np.asarray((frame.from_base(from_arcs(fitted)) - points).ravel() / (TYPICAL_RESIDUAL * extent))

    unmoved = np.zeros(moves.sum() + (len(within) - 1 if axis is None else 0))
    starts = sorted(
        _starts(flat, within, origin, axis), key=lambda start: float(np.log1p(residuals(unmoved, start) ** 2).sum())
    )
    fits = [
        (start, least_squares(residuals, unmoved, args=(start,), loss="soft_l1", x_scale=0.1, max_nfev=60))
        for start in starts[:REFINED_STARTS]
    ]
    start, best = min(fits, key=lambda pair: float(pair[1].cost))
    return moved(start, best.x)


def _starts(points: Array, within: Array, origin: Array, axis: Array | None) -> Sequence[BaseFrame]:
    """Frames to start from: along every signed coordinate axis of the robot's space (rows of `within`), at `STARTS`."""
    axes = [sign * row for row in within for sign in (1.0, -1.0)] if axis is None else [axis]
    middle = np.median(points, axis=0)
    starts = []
    for along, depth in itertools.product(axes, STARTS):
        height = (points - middle) @ along
        aside = np.linalg.norm(points - middle - np.outer(height, along), axis=1).max()
        start = middle + along * (height.max() - depth * aside)
        starts.append(BaseFrame(np.where(np.isnan(origin), start, origin), along))
    return starts


def _bytes(array: Array | None) -> bytes | None:
    return None if array is None else array.tobytes()


def _unit(axis: Any) -> Array:
    vector = np.asarray(axis, dtype=np.float64)
    return np.asarray(vector / np.linalg.norm(vector))
