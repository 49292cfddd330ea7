"""Residuals in the order of a recording."""

from __future__ import annotations

import numpy as np

from softkin.core.samples import SUBSETS
from softkin.core.time_residuals import lag_one, time_residuals
from tests.conftest import four_subsets
from tests.recorded_robot import NOISE_MM, recorded_arm


def test_residuals_come_in_the_order_of_time_and_know_their_session() -> None:
    rows = recorded_arm(400, zeros_mm=(0.0, 2.0))
    order = np.random.default_rng(0).permutation(400)
    parts = {subset: rows.take(part) for subset, part in zip(SUBSETS, np.array_split(order, 4), strict=True)}
    parts["test"].positions[0] += 90.0
    known = time_residuals(parts)
    assert known is not None
    assert len(known.order) == 399  # without the gross error
    assert (np.diff(known.order) > 0).all()
    assert (known.session == 1 + (known.order > 200)).all()
    np.testing.assert_allclose(np.ptp(known.zeros(), axis=0), [2.0, 0.0, 0.0], atol=0.3)
    assert abs(known.without_zeros().std() - NOISE_MM) < 0.2
    assert len(known.pairs()) == 397
    follows = np.flatnonzero((np.diff(known.order) == 1) & (np.diff(known.session) == 0))
    np.testing.assert_allclose(known.step[follows + 1], np.diff(known.commands, axis=0)[follows])


def test_without_a_recording_there_are_none() -> None:
    assert time_residuals(four_subsets(dict.fromkeys(SUBSETS, 60))) is None


def test_neighbours_that_are_alike_correlate() -> None:
    noise = np.random.default_rng(0).standard_normal((2000, 2))
    smooth = noise[1:] + noise[:-1]
    np.testing.assert_allclose(lag_one(smooth, np.arange(1998)), 0.5, atol=0.05)
    np.testing.assert_allclose(lag_one(noise, np.arange(1999)), 0.0, atol=0.06)
    assert (lag_one(np.zeros((5, 1)), np.arange(4)) == 0).all()
