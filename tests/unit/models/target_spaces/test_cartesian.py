from __future__ import annotations

import numpy as np
import pytest

from softkin.models.target_spaces.cartesian import SPACE
from tests.conftest import bending_arm


@pytest.mark.parametrize(("skip_constant", "n_targets"), [(True, 3), (False, 6)])
def test_targets_are_standardised_positions_and_come_back(skip_constant: bool, n_targets: int) -> None:
    rows = bending_arm(50, n_commands=3, n_markers=2)
    space = SPACE.transformer(skip_constant, None).fit(rows.positions, rows.commands)
    targets = space.transform(rows.positions)
    assert targets.shape == (50, n_targets)
    np.testing.assert_allclose(targets[:, -3:].mean(axis=0), 0.0, atol=1e-12)
    np.testing.assert_allclose(targets[:, -3:].std(axis=0), 1.0)
    np.testing.assert_allclose(space.inverse_transform(targets), rows.positions, atol=1e-10)
    spread = space.inverse_spread(targets, np.ones_like(targets))
    np.testing.assert_allclose(spread[:, 3:], np.broadcast_to(rows.positions[:, 3:].std(axis=0), (50, 3)))


def test_the_base_of_the_robot_changes_nothing() -> None:
    rows = bending_arm(50)
    base = {"origin": [1.0, 2.0, 3.0], "axis": [0.0, 1.0, 0.0]}
    one, other = (SPACE.transformer(True, each).fit(rows.positions, rows.commands) for each in (None, base))
    np.testing.assert_array_equal(one.transform(rows.positions), other.transform(rows.positions))
