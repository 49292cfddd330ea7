"""Targets of a marker, read from whatever holds them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import SoftkinError
from softkin.uncertainty.calls import Names
from softkin.uncertainty.targets import checked_step, checked_tolerance, marker_of, target_rows

PLANAR = Names(1, 6, ["p"], ["base x", "base y", "tip x", "tip y"], 10.0, 2)


def test_targets_by_the_robots_own_names_are_in_its_own_unit() -> None:
    own = pd.DataFrame({"tip y": [2.0], "tip x": [1]})
    np.testing.assert_array_equal(target_rows(own, PLANAR, 1, "arm"), [[10.0, 20.0, 0.0]])
    named = pd.DataFrame({"m2_z": [0.0], "m2_x": [10.0], "m2_y": [20.0]})
    np.testing.assert_array_equal(target_rows(named, PLANAR, 1, "arm"), [[10.0, 20.0, 0.0]])
    np.testing.assert_array_equal(target_rows([1, 2, 3], PLANAR, 0, "arm"), [[1.0, 2.0, 3.0]])
    np.testing.assert_array_equal(target_rows(own.iloc[0], PLANAR, 1, "arm"), [[10.0, 20.0, 0.0]])
    with pytest.raises(SoftkinError, match="missing 'tip x', 'tip y'; unknown 'base x', 'base y'"):
        target_rows(pd.DataFrame({"base x": [1.0], "base y": [1.0]}), PLANAR, 1, "arm")


@pytest.mark.parametrize(("marker", "number"), [(-1, 6), (0, 0), (np.int64(3), 3), (-7, 0)])
def test_markers_count_from_either_end(marker: Any, number: int) -> None:
    assert marker_of(marker, 7, "arm") == number


@pytest.mark.parametrize("marker", [7, -8, 1.0, True, "tip", None])
def test_no_such_marker(marker: Any) -> None:
    with pytest.raises(SoftkinError, match="is no marker of this robot"):
        marker_of(marker, 7, "arm")


@pytest.mark.parametrize("tolerance", [0, -1.0, float("nan"), float("inf"), True, "1"])
def test_no_such_tolerance(tolerance: Any) -> None:
    with pytest.raises(SoftkinError, match="is no tolerance"):
        checked_tolerance(tolerance, "arm")


@pytest.mark.parametrize("step", [0, [1.0, -1.0], [1.0, 1.0, 1.0], float("nan"), "1"])
def test_no_such_step(step: Any) -> None:
    with pytest.raises(SoftkinError, match="max_step"):
        checked_step(step, 2, "arm")


def test_a_step_is_of_all_commands_or_of_each() -> None:
    assert checked_step(None, 2, "arm") is None
    assert checked_tolerance(None, "arm") is None
    np.testing.assert_array_equal(checked_step(1, 2, "arm"), [1.0, 1.0])
    np.testing.assert_array_equal(checked_step([1, 2], 2, "arm"), [1.0, 2.0])
