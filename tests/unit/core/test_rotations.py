from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from softkin.core.rotations import (
    KINDS,
    MATRIX,
    XYZW,
    about,
    angles,
    are_none,
    from_mean,
    mean_of,
    to_numbers,
    to_vectors,
)

VECTORS = 0.6 * np.random.default_rng(0).standard_normal((40, 3))
#: A turn of the tracker's frame.
FRAME = Rotation.from_rotvec([0.4, -2.0, 1.1])


def in_frame(vectors: np.ndarray) -> np.ndarray:
    return (FRAME * Rotation.from_rotvec(vectors)).as_rotvec()


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_comes_back_and_is_a_rotation(kind: str) -> None:
    numbers = to_numbers(VECTORS, kind)
    assert numbers.shape == (40, KINDS[kind])
    assert not are_none(numbers, kind).any()
    np.testing.assert_allclose(to_vectors(numbers, kind), VECTORS, atol=1e-12)


def test_roll_pitch_and_yaw_turn_about_fixed_axes_one_after_the_other() -> None:
    vector = to_vectors(np.radians([[30.0, 0.0, 90.0]]), "roll_pitch_yaw_radians")
    np.testing.assert_allclose(to_vectors(np.array([[30.0, 0.0, 90.0]]), "roll_pitch_yaw_degrees"), vector)
    yaw, roll = Rotation.from_euler("z", 90, degrees=True), Rotation.from_euler("x", 30, degrees=True)
    np.testing.assert_allclose(vector[0], (yaw * roll).as_rotvec())


def test_a_quaternion_and_its_negative_are_one_rotation() -> None:
    numbers = to_numbers(VECTORS, XYZW)
    np.testing.assert_allclose(angles(to_vectors(numbers, XYZW), to_vectors(-numbers, XYZW)), 0.0, atol=1e-5)


def test_angles_are_in_degrees_and_the_same_in_every_frame() -> None:
    assert angles(np.zeros((1, 3)), np.array([[0.0, np.pi / 3, 0.0]]))[0] == pytest.approx(60.0)
    other = VECTORS[::-1]
    np.testing.assert_allclose(angles(in_frame(VECTORS), in_frame(other)), angles(VECTORS, other), atol=1e-9)


def test_vectors_about_the_mean_do_not_know_the_frame_and_average_to_nothing() -> None:
    mean = mean_of(VECTORS)
    turned = about(VECTORS, mean)
    np.testing.assert_allclose(mean_of(turned), 0.0, atol=1e-12)
    np.testing.assert_allclose(from_mean(turned, mean), VECTORS, atol=1e-12)
    np.testing.assert_allclose(mean_of(in_frame(VECTORS)), in_frame(mean[None])[0], atol=1e-9)
    np.testing.assert_allclose(about(in_frame(VECTORS), mean_of(in_frame(VECTORS))), turned, atol=1e-9)


def test_what_is_no_rotation_is_seen() -> None:
    quaternions = to_numbers(VECTORS[:3], XYZW) * np.array([[1.01], [0.9], [0.0]])
    assert are_none(quaternions, XYZW).tolist() == [False, True, True]
    matrices = to_numbers(VECTORS[:3], MATRIX) * np.array([[1.0], [-1.0], [1.1]])
    assert are_none(matrices, MATRIX).tolist() == [False, True, True]
