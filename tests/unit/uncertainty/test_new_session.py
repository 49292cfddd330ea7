"""Intervals in a session never seen."""

from __future__ import annotations

import numpy as np
from scipy.stats import t

from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.new_session import widened, zero_spread
from tests.conftest import bending_arm
from tests.recorded_robot import recorded_arm

ROWS = recorded_arm(300, zeros_mm=(0.0, 2.0, -2.0))


def test_unseen_sessions_are_wider_by_the_spread_of_the_known_ones() -> None:
    settings = FitSettings({"degree": 2, "alpha": 1e-3}, True, 0, 1, memory={"memory": "none", "zeros": True})
    model = fitted_model(MODELS["ridge"], settings, ROWS)
    spread = zero_spread(model)
    assert spread is not None
    np.testing.assert_allclose(spread, [2.0, 0.0, 0.0], atol=0.1)
    predicted = model.predict(ROWS.inputs[:2])
    bounds = np.stack([predicted - 0.5, predicted + 1.0], axis=-1)[None]
    inputs = ROWS.inputs[:2].copy()
    inputs[1, -1] = 9
    wide = widened(bounds, predicted, model, inputs, [0.9])
    np.testing.assert_allclose(wide[:, 0], bounds[:, 0])
    zero = t.ppf(0.95, 2) * spread[0] * np.sqrt(4 / 3)
    np.testing.assert_allclose(wide[0, 1, 0] - predicted[1, 0], [-np.hypot(0.5, zero), np.hypot(1.0, zero)])
    bare = widened(bounds, predicted, model, ROWS.commands[:2], [0.9])
    assert (np.ptp(bare, axis=-1)[..., 0] > 2 * np.ptp(bounds, axis=-1)[..., 0]).all()


def test_without_sessions_nothing_changes() -> None:
    rows = bending_arm(60)
    model = fitted_model(MODELS["lr"], FitSettings({}, True, 0, 1), rows)
    bounds = np.zeros((1, 60, 3, 2))
    assert zero_spread(model) is None
    assert widened(bounds, rows.positions, model, rows.commands, [0.9]) is bounds
