"""The shape of the region that holds whole poses: chosen on `train` alone, and what sets its size."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import Shell
from softkin.uncertainty.joint_region import chosen_shape, joint_region

MARKERS = np.array([0, 0, 0, 1, 1, 1])
CORRELATED = np.kron(np.eye(2), np.array([[1.0, 0.9, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 2.0]]))
MOVING = np.array([True, True, True, False, False, False])


def errors(n: int, mix: Array, seed: int = 0) -> Array:
    return np.asarray(np.random.default_rng(seed).standard_normal((n, 6)) @ mix)


def test_ellipsoids_where_errors_correlate_else_a_box() -> None:
    assert chosen_shape(errors(400, CORRELATED), MARKERS).kind == "ellipsoids"
    uniform = np.random.default_rng(0).uniform(-1, 1, (400, 6))
    assert chosen_shape(uniform, MARKERS).kind == "box"


def test_where_rows_are_few_or_the_model_repeats_train_it_is_a_box() -> None:
    assert chosen_shape(errors(8, CORRELATED), MARKERS).kind == "box"
    exact = chosen_shape(np.zeros((50, 6)), MARKERS)
    assert exact.kind == "box"
    assert np.isfinite(exact.scores(errors(5, CORRELATED))).all()


def test_a_few_gross_errors_do_not_change_the_shape() -> None:
    rows = errors(400, CORRELATED)
    with_gross = rows.copy()
    with_gross[:4] += 500.0
    clean, gross = (chosen_shape(part, MARKERS) for part in (rows, with_gross))
    assert clean.kind == gross.kind == "ellipsoids"
    np.testing.assert_allclose(gross.half_widths, clean.half_widths, rtol=0.2)


def test_the_calibration_set_decides_the_size_alone() -> None:
    train = errors(200, CORRELATED)
    one, other = (joint_region(train, errors(80, mix, 1), MOVING, ()) for mix in (CORRELATED, 9 * np.eye(6)))
    np.testing.assert_array_equal(one.shape.half_widths, other.shape.half_widths)
    np.testing.assert_array_equal(one.scores, one.shape.scores(errors(80, CORRELATED, 1)[:, :3]))
    assert one.scores.shape == (80,)
    assert np.median(other.scores) > 3 * np.median(one.scores)
    np.testing.assert_array_equal(one.markers, [0, 0, 0])


def test_a_constant_coordinate_is_as_far_off_as_it_ever_was() -> None:
    residuals = errors(80, CORRELATED, 1)
    region = joint_region(errors(200, CORRELATED), residuals, MOVING, ())
    np.testing.assert_array_equal(region.constant[:3], 0.0)
    np.testing.assert_array_equal(region.constant[3:], np.abs(residuals[:, 3:]).max(axis=0))


def test_shells_hold_what_the_region_must_grow_to() -> None:
    commands, truth = np.ones((40, 2)), errors(40, CORRELATED, 2)
    shell = Shell(commands[:20], commands, truth - 2.0, truth)
    region = joint_region(errors(200, CORRELATED), truth, MOVING, [shell])
    (found,) = region.shells
    np.testing.assert_array_equal(found.core_commands, shell.core_commands)
    assert found.truth.shape == (40, 1)
    expected = region.shape.scores(np.full((1, 3), 2.0))[0]
    assert (found.truth - found.predicted) == pytest.approx(np.full((40, 1), expected))
