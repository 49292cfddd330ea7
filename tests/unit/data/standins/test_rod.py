"""Rods, loads, shapes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from softkin.core.errors import ConfigError
from softkin.data.standins.rod import STANDARD_GRAVITY, Rod, Shape, disc, loads, section

ROD = Rod(100.0, *section(1.0, *disc(5.0)), tendons=((4.0, 0.0), (-4.0, 0.0)))


def test_section_of_an_incompressible_disc() -> None:
    area, second_moment = disc(2.0)
    stretching, bending = section(3.0, area, second_moment)
    assert stretching == pytest.approx((4 * math.pi, 4 * math.pi, 12 * math.pi))
    assert bending == pytest.approx((12 * math.pi, 12 * math.pi, 8 * math.pi))


def test_weight() -> None:
    assert Rod(1.0, *section(1.0, 1.0, 1.0), mass_per_length=1000.0).weight_per_length == pytest.approx(9.80665)
    assert pytest.approx(9.80665 / 1000) == STANDARD_GRAVITY


def test_loads_are_broadcast_to_rows() -> None:
    rows = loads(ROD, 3, tip_force=(1.0, 2.0, 3.0), tensions=np.arange(6.0).reshape(3, 2))
    assert len(rows) == 3
    assert rows.tip_force.tolist() == [[1.0, 2.0, 3.0]] * 3
    assert rows.pressures.shape == (3, 0)
    assert rows.rows(np.array([2])).tensions.tolist() == [[4.0, 5.0]]
    assert rows.scaled(0.5).tensions[2].tolist() == [2.0, 2.5]


def test_scaling_leaves_the_sliding() -> None:
    assert loads(ROD, 1, tensions=1.0, slides=-1.0).scaled(0.25).slides.tolist() == [[-1.0, -1.0]]


@pytest.mark.parametrize(
    ("load", "says"),
    [
        ({"tip_force": (0.0, math.nan, 0.0)}, r"field 'tip_force', row 0: not finite"),
        ({"tensions": np.array([[1.0, 0.0], [0.0, -1.0]])}, r"field 'tensions', row 1: a tendon cannot push"),
        ({"pressures": np.ones((2, 3))}, r"field 'pressures': shape \(2, 3\) does not fit \(2, 0\)"),
    ],
)
def test_bad_loads_are_named(load: dict[str, Any], says: str) -> None:
    with pytest.raises(ConfigError, match=says):
        loads(ROD, 2, **load)


def test_points_lie_beside_the_centreline() -> None:
    quarter = math.sqrt(0.5)  # of a turn about z: x goes to y
    quaternions = np.array([[[1.0, 0, 0, 0], [quarter, 0, 0, quarter]]])
    positions = np.array([[[0.0, 0, 0], [0, 0, 10.0]]])
    shape = Shape(positions, quaternions, positions, positions)
    points = shape.points([0, 1], (3.0, 1.0))
    np.testing.assert_allclose(points, [[[3, 1, 0], [-1, 3, 10]]], atol=1e-12)
