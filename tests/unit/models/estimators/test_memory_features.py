"""Features of memory, in front of any model."""

from __future__ import annotations

import numpy as np
import pytest
from sklearn.base import clone

from softkin.core.recording import WIDTHS
from softkin.models.estimators.memory_features import MEMORIES, NONE, PLAY, WIDTH_SETS, MemoryFeatures, n_features
from tests.recorded_robot import recorded_arm


@pytest.mark.parametrize("memory", MEMORIES)
@pytest.mark.parametrize("widths", WIDTH_SETS)
def test_the_commands_come_first_and_the_step_after_them(memory: str, widths: str) -> None:
    rows = recorded_arm(30)
    features = clone(MemoryFeatures(2, memory, widths)).fit(rows.inputs).transform(rows.inputs)
    assert features.shape == (30, n_features(2, memory, widths))
    np.testing.assert_array_equal(features[:, :2], rows.commands)
    if memory != NONE:
        np.testing.assert_allclose(features[1:, 2:4], np.diff(rows.commands, axis=0))


def test_play_operators_say_where_in_its_play_the_robot_stands() -> None:
    rows = recorded_arm(300)
    stops = MemoryFeatures(2, PLAY, "all").transform(rows.inputs)[:, 4:].reshape(300, len(WIDTHS), 2)
    halves = np.outer(WIDTHS, np.ptp(rows.commands, axis=0))
    assert (np.abs(stops) <= halves + 1e-12).all()
    assert (np.abs(stops).max(axis=0) > 0.99 * halves).all()
