from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from softkin.core.samples import Samples
from softkin.data.audit.extrapolation_support import check, off_hull
from tests.unit.data.audit.clean_robot import clean_robot
from tests.unit.data.audit.conftest import Replace


@given(st.integers(0, 10_000), st.integers(2, 4))
@settings(max_examples=15, deadline=None)
def test_the_hull_is_that_of_a_triangulation(seed: int, n_columns: int) -> None:
    rng = np.random.default_rng(seed)
    hull, points = rng.uniform(-1, 1, (40, n_columns)), rng.uniform(-1, 1, (20, n_columns))
    np.testing.assert_array_equal(off_hull(points, hull), Delaunay(hull).find_simplex(points) < 0)


def test_a_corner_of_the_hull_and_a_mean_of_corners_lie_inside() -> None:
    hull = np.random.default_rng(0).standard_normal((100, 64))
    within = np.vstack([hull[:3], hull[:10].mean(axis=0)])
    assert not off_hull(within, hull).any()
    assert off_hull(3 * hull[:3], hull).all()


def test_off_the_plane_of_a_command_that_never_varies_is_outside() -> None:
    hull = np.column_stack([np.random.default_rng(0).uniform(-1, 1, (50, 2)), np.zeros(50)])
    assert off_hull(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.1]]), hull).tolist() == [False, True]


def test_extrapolation_among_the_train_rows_is_a_finding(robot: dict[str, Samples], changed: Replace) -> None:
    inner = 0.5 * robot["extrapolation"].commands
    result = check(changed("extrapolation", slice(None), commands=inner))
    (finding,) = result.findings
    assert (finding.code, finding.severity, finding.subsets) == ("extrapolation_inside", "warning", ("extrapolation",))


@pytest.mark.parametrize("n_commands", [1, 2, 6, 64])
def test_an_outer_shell_is_no_finding(n_commands: int) -> None:
    result = check(clean_robot(400, n_commands=n_commands, seed=1))
    assert not result.findings
    assert result.numbers["extrapolation"]["share_outside_hull"] == 1.0
    assert result.numbers["extrapolation"]["norm_min"] >= result.numbers["train"]["norm_max"]
