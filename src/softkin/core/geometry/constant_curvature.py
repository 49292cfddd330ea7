"""Constant-curvature kinematics: points in the frame of the base <-> the arcs that lead to them.

Source: Webster and Jones (2010), *Design and kinematic modeling of constant curvature continuum robots: a review*,
International Journal of Robotics Research 29(13).
"""

from __future__ import annotations

import numpy as np

from softkin.core.samples import CONSTANT_RANGE_MM, Array

#: Largest bending (rad) that is told apart: near 2 pi an arc ends where it begins, and its direction is lost.
MAX_BENDING = 1.95 * np.pi
#: Below it (rad) a series is used: its first term that is left out is below 1e-14.
SMALL_ANGLE = 0.3


def to_arcs(points: Array) -> Array:
    """Points (n_rows, n_markers, 3) in mm -> arcs (n_rows, n_markers, 3): bending angle towards x and y (rad), length
    (mm).

    The arc leaves the base along z and ends at (x, y, z) = p: with r = hypot(x, y) it bends by b = 2 atan2(r, z)
    towards (x, y) / r, and its length is b |p| / (2 sin(b / 2)), or z where it is straight. Bending beyond
    `MAX_BENDING` counts as that.
    """
    x, y, z = np.moveaxis(points, -1, 0)
    r = np.hypot(x, y)
    bending = np.minimum(2 * np.arctan2(r, z), MAX_BENDING)
    per_mm = np.divide(bending, r, out=np.zeros_like(r), where=r > 0)
    length = np.linalg.norm(points, axis=-1) / _sinc(bending / 2)
    return np.stack([per_mm * x, per_mm * y, length], axis=-1)


def from_arcs(arcs: Array) -> Array:
    """The inverse of `to_arcs`, for arcs of any bending (n_rows, n_markers, 3).

    x = s (1 - cos b) / b * b_x / b = s b_x / 2 (sin(b / 2) / (b / 2))^2, z = s sin(b) / b; sinc needs no division by 0.
    """
    b_x, b_y, length = arcs[..., 0], arcs[..., 1], arcs[..., 2]
    bending = np.hypot(b_x, b_y)
    sideways, points = length / 2 * np.square(_sinc(bending / 2)), np.empty_like(arcs)
    points[..., 0], points[..., 1], points[..., 2] = sideways * b_x, sideways * b_y, length * _sinc(bending)
    return points


def spread_of_points(arcs: Array, spread: Array, axes: Array) -> Array:
    """Standard deviation of points (n_rows, n_markers, 3) along `axes` (3, 3), to first order, from that of their arcs'
    coordinates, which are taken to be independent.
    """
    b_x, b_y, length = np.moveaxis(arcs, -1, 0)
    bending = np.hypot(b_x, b_y)
    half, whole = _sinc(bending / 2), _sinc(bending)
    sideways, narrower = length / 2 * np.square(half), length / 4 * half * _sinc_slope(bending / 2)
    lower = length * _sinc_slope(bending)
    along_x = np.stack([sideways + narrower * b_x * b_x, narrower * b_x * b_y, lower * b_x], axis=-1)
    along_y = np.stack([narrower * b_x * b_y, sideways + narrower * b_y * b_y, lower * b_y], axis=-1)
    along = np.stack([np.square(half) / 2 * b_x, np.square(half) / 2 * b_y, whole], axis=-1)
    slopes = (along_x, along_y, along)
    moved = [np.square((slope * spread[..., axis : axis + 1]) @ axes) for axis, slope in enumerate(slopes)]
    return np.asarray(np.sqrt(moved[0] + moved[1] + moved[2]))


def has_arc(points: Array) -> Array:
    """Mask (n_rows, n_markers) of the points (n_rows, n_markers, 3) that exactly one arc leads to: away from the base,
    bent by at most `MAX_BENDING`.
    """
    x, y, z = np.moveaxis(points, -1, 0)
    away = np.linalg.norm(points, axis=-1) > CONSTANT_RANGE_MM
    return np.asarray(away & (2 * np.arctan2(np.hypot(x, y), z) <= MAX_BENDING))


def _sinc(angle: Array) -> Array:
    """sin(angle) / angle: numpy.sinc(angle / pi) to the bit, without what it asks of other types of numbers."""
    angle = np.pi * (angle / np.pi)
    divisor = np.where(angle, angle, 1e-16)
    return np.asarray(np.sin(divisor) / divisor)


def _sinc_slope(angle: Array) -> Array:
    """The derivative of sin(angle) / angle, divided by the angle: its series where the difference would cancel."""
    square = np.square(angle)
    near = -1 / 3 + square * (1 / 30 - square * (1 / 840 - square * (1 / 45360 - square / 3991680)))
    direct = (np.cos(angle) - _sinc(angle)) / np.where(square > 0, square, 1.0)
    return np.where(square < SMALL_ANGLE**2, near, direct)
