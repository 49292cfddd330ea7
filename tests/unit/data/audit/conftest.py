from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from softkin.core.samples import Samples
from tests.unit.data.audit.clean_robot import clean_robot

Replace = Callable[..., dict[str, Samples]]


@pytest.fixture
def robot() -> dict[str, Samples]:
    """A clean robot of 2 commands and 2 markers: 392 rows in train, 49 in validation and in test, 210 outside."""
    return clean_robot(700, n_commands=2, n_markers=2, seed=3)


@pytest.fixture
def changed(robot: dict[str, Samples]) -> Replace:
    """changed(subset, rows, commands=..., positions=...): the robot with these rows replaced."""

    def change(
        subset: str, rows: object, commands: object = None, positions: object = None, of: object = None
    ) -> dict[str, Samples]:
        base: dict[str, Samples] = robot if of is None else of  # type: ignore[assignment]
        u, x = np.copy(base[subset].commands), np.copy(base[subset].positions)
        if commands is not None:
            u[rows] = commands  # type: ignore[index]
        if positions is not None:
            x[rows] = positions  # type: ignore[index]
        return {**base, subset: Samples(u, x)}

    return change
