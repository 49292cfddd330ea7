from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from softkin.models.estimators.position_scaler import PositionScaler

positions = arrays(float, (8, 3), elements=st.floats(-1e4, 1e4).map(lambda x: round(x, 3)))


@given(positions, st.booleans())
def test_round_trip(x: np.ndarray, skip: bool) -> None:
    scaler = PositionScaler(skip).fit(x)
    np.testing.assert_allclose(scaler.inverse_transform(scaler.transform(x)), x, atol=1e-9)


@pytest.mark.parametrize(("skip", "kept"), [(True, 1), (False, 3)])
def test_only_exact_constants_are_left_out(skip: bool, kept: int) -> None:
    x = np.column_stack([np.full(5, 3.3), np.arange(5.0), np.full(5, -1.0)])
    scaler = PositionScaler(skip).fit(x)
    assert scaler.transform(x).shape == (5, kept)
    np.testing.assert_array_equal(scaler.inverse_transform(scaler.transform(x))[:, 0], x[:, 0])


def test_a_robot_that_never_moves_is_still_handed_to_the_model() -> None:
    assert PositionScaler().fit(np.ones((4, 3))).transform(np.ones((4, 3))).shape == (4, 3)


def test_a_spread_gets_its_unit_back_and_none_where_nothing_moves() -> None:
    positions = np.column_stack([np.full(5, 7.0), np.arange(5.0), 10 * np.arange(5.0)])
    scaler = PositionScaler().fit(positions)
    spread = scaler.inverse_spread(np.zeros((1, 2)), np.array([[1.0, 0.5]]))
    np.testing.assert_allclose(spread, [[0.0, np.arange(5.0).std(), 5 * np.arange(5.0).std()]])
