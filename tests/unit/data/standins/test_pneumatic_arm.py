"""The arm bends as an arm with three chambers must."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.data.standins.pneumatic_arm import CHAMBERS, LENGTH, LOWER, MARKER_OFFSET, ROD, SPEC, UPPER
from softkin.data.standins.rod import STANDARD_GRAVITY


def markers(*commands: tuple[float, float, float]) -> Array:
    """Positions (n_rows, 7, 3)."""
    positions = SPEC.poses(np.array(commands), np.random.default_rng(0))
    return positions.reshape(len(commands), 7, 3)


def test_the_more_pressure_the_more_bend() -> None:
    tips = markers(*[(-pressure, 0.0, -0.09) for pressure in np.linspace(0, 1, 6)])[:, -1]
    out = np.hypot(*tips[:, :2].T)
    assert (np.diff(out) > 20).all()
    assert (np.diff(tips[:, 2]) < 0).all()
    assert (tips[:, :2] < 0).all()  # away from the first chamber


def test_swapping_the_trimming_chambers_mirrors_the_arm() -> None:
    """They lie on either side of the plane x = y, in which the arm's bow, its markers and the first chamber lie."""
    one, other = markers((-0.5, 0.05, -0.1), (-0.5, -0.1, 0.05))
    np.testing.assert_allclose(one[:, [1, 0, 2]], other, atol=1e-5)
    assert np.abs(one - other).max() > 5


def test_equal_pressures_only_stretch() -> None:
    """Equal pressures bend nothing: the arm leans a little further for being longer, and keeps its plane."""
    shape = markers((0.0, 0.0, 0.0), (-0.1, -0.1, -0.1))
    np.testing.assert_allclose(shape[..., 0], shape[..., 1], atol=1e-5)
    spacing = np.linalg.norm(np.diff(shape, axis=1), axis=2)
    strain = 0.3 * ROD.chamber_area / ROD.stretch_stiffness[2]
    np.testing.assert_allclose(spacing[1] / spacing[0] - 1, strain, rtol=0.1)


def test_it_stands_far_from_buckling_and_is_built_symmetrically() -> None:
    assert ROD.mass_per_length * STANDARD_GRAVITY * LENGTH**3 / ROD.bend_stiffness[0] < 0.5 * 7.837
    np.testing.assert_allclose(np.sum(CHAMBERS, axis=0), 0, atol=1e-12)


def test_the_base_marker_never_moves_to_the_last_bit() -> None:
    commands = SPEC.draw(50, np.random.default_rng(1))
    base = markers(*map(tuple, commands))[:, 0]
    assert np.array_equal(base, np.tile([*MARKER_OFFSET, 0.0], (50, 1)))


def test_more_elements_change_nothing_that_matters(monkeypatch: pytest.MonkeyPatch) -> None:
    extremes = [(u1, u2, u3) for u1 in (LOWER[0], UPPER[0]) for u2 in (-0.1, 0.1) for u3 in (-0.1, -0.08)]
    coarse = markers(*extremes)
    monkeypatch.setattr("softkin.data.standins.pneumatic_arm.N_ELEMENTS", 96)
    np.testing.assert_allclose(coarse, markers(*extremes), atol=1e-3)
