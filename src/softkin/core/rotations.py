"""Rotations of a robot's tip: what files write, rotation vectors, their mean, and angles between them.

A rotation vector (rad) points along the axis and is as long as the angle; about a mean rotation M, the rotation R is
M exp(r), so that r does not change where the tracker's frame is turned. Source: Moakher (2002), Means and averaging in
the group of rotations. All arithmetic is scipy's.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

XYZW, WXYZ, DEGREES, RADIANS, MATRIX = (
    "quaternion_xyzw",
    "quaternion_wxyz",
    "roll_pitch_yaw_degrees",
    "roll_pitch_yaw_radians",
    "rotation_matrix",
)
#: What a file may write of a rotation, and in how many numbers. Roll, pitch and yaw turn about the fixed axes x, y and
#: z, one after the other; a matrix is written row by row.
KINDS = {XYZW: 4, WXYZ: 4, DEGREES: 3, RADIANS: 3, MATRIX: 9}
#: A quaternion's norm is 1 within this, and so are the products of a matrix and its transpose those of the identity.
TOLERANCE = 0.02
_TURNS = "xyz"


def to_vectors(numbers: Array, kind: str) -> Array:
    """Rotation vectors (n_rows, 3) in rad of what a file writes (n_rows, KINDS[kind])."""
    from scipy.spatial.transform import Rotation

    if kind in (XYZW, WXYZ):
        rotations = Rotation.from_quat(numbers, scalar_first=kind == WXYZ)
    elif kind == MATRIX:
        rotations = Rotation.from_matrix(numbers.reshape(-1, 3, 3))
    else:
        rotations = Rotation.from_euler(_TURNS, numbers, degrees=kind == DEGREES)
    return np.asarray(rotations.as_rotvec())


def to_numbers(vectors: Array, kind: str) -> Array:
    """What a file writes (n_rows, KINDS[kind]) of rotation vectors (n_rows, 3) in rad: the inverse of `to_vectors`."""
    rotations = _rotations(vectors)
    if kind in (XYZW, WXYZ):
        return np.asarray(rotations.as_quat(canonical=True, scalar_first=kind == WXYZ))
    if kind == MATRIX:
        return np.asarray(rotations.as_matrix()).reshape(-1, 9)
    return np.asarray(rotations.as_euler(_TURNS, degrees=kind == DEGREES))


def are_none(numbers: Array, kind: str) -> NDArray[np.bool_]:
    """Which rows (n_rows,) are no rotation: a quaternion that is not of unit norm, a matrix that is not orthonormal or
    mirrors. Angles all are.
    """
    if kind in (XYZW, WXYZ):
        return np.asarray(np.abs(np.linalg.norm(numbers, axis=1) - 1) > TOLERANCE)
    if kind == MATRIX:
        matrices = numbers.reshape(-1, 3, 3)
        off = np.abs(matrices @ matrices.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
        return np.asarray((off > TOLERANCE) | (np.linalg.det(matrices) < 0))
    return np.zeros(len(numbers), dtype=bool)


def mean_of(vectors: Array) -> Array:
    """The mean rotation, as a rotation vector (3,) in rad, of rotation vectors (n_rows, 3)."""
    return np.asarray(_rotations(vectors).mean().as_rotvec())


def about(vectors: Array, mean: Array) -> Array:
    """Rotation vectors (n_rows, 3) in rad about a mean rotation (3,), of such about none."""
    return np.asarray((_rotations(mean).inv() * _rotations(vectors)).as_rotvec())


def from_mean(vectors: Array, mean: Array) -> Array:
    """Rotation vectors (n_rows, 3) in rad about none, of such about a mean rotation (3,)."""
    return np.asarray((_rotations(mean) * _rotations(vectors)).as_rotvec())


def angles(one: Array, other: Array) -> Array:
    """The angles (n_rows,) in degrees, 0 to 180, between rotation vectors (n_rows, 3) about the same mean."""
    return np.asarray(np.degrees((_rotations(one).inv() * _rotations(other)).magnitude()))


def _rotations(vectors: Array) -> Rotation:
    from scipy.spatial.transform import Rotation

    return Rotation.from_rotvec(np.array(vectors))  # it refuses arrays that may not be written to
