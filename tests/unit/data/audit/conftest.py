from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from softkin.core.samples import Samples
from tests.unit.data.audit.clean_robot import clean_robot

Replace = Callable[..., dict[str, Samples]]


@pytest.fixture
def robot() -> dict[str, Samples]:
    """A clean robot of 2 commands and 2 markers: 392 rows in train, 49 in validation and test, 210 in extrapolation."""
    return clean_robot(700, n_commands=2, n_markers=2, seed=3)


@pytest.fixture
def changed(robot: dict[str, Samples]) -> Replace:
    """changed(subset, rows, commands=..., positions=...): the robot with these rows replaced."""

    def change(
        subset: str, rows: Any, commands: Any = None, positions: Any = None, of: dict[str, Samples] | None = None
    ) -> dict[str, Samples]:
        base = robot if of is None else of
        u, x = np.copy(base[subset].commands), np.copy(base[subset].positions)
        if commands is not None:
            u[rows] = commands
        if positions is not None:
            x[rows] = positions
        return {**base, subset: Samples(u, x)}

    return change
