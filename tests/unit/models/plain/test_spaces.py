from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from softkin.models.plain.describe_spaces import described_space
from softkin.models.plain.spaces import space
from softkin.models.target_spaces import TARGET_SPACES
from tests.conftest import bending_arm

ROWS = bending_arm(50, n_markers=3, seed=4)
BASE: dict[str, Any] = {"origin": [0, 0, 0], "axis": [0, 0.1, 1]}


@pytest.mark.parametrize("name", TARGET_SPACES)
@pytest.mark.parametrize("shift", [0.0, 1e-8])
def test_a_space_in_plain_numbers_maps_as_its_transformer(name: str, shift: float) -> None:
    positions = ROWS.positions.copy()
    positions[::2, 0] += shift
    transformer = TARGET_SPACES[name].transformer(True, BASE).fit(positions, ROWS.commands)
    targets = transformer.transform(positions)
    spread = np.abs(np.random.default_rng(0).normal(size=targets.shape))
    plain = space(described_space(transformer))
    np.testing.assert_allclose(plain.positions(targets), transformer.inverse_transform(targets), rtol=0, atol=1e-12)
    np.testing.assert_allclose(plain.spread(targets, spread), transformer.inverse_spread(targets, spread), atol=1e-12)
