"""Models of recorded rows: memory and zeros."""

from __future__ import annotations

from typing import Any

import joblib
import numpy as np
import pytest

from softkin.models import MODELS
from softkin.models.estimators.in_sessions import InSessions, session_zeros
from softkin.models.estimators.memory_features import MEMORIES
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.training.predict import spread_of
from tests.recorded_robot import bent, recorded_arm

GP = {"kernel": "rbf", "trend": "linear", "max_iter": 20, "learning_rows": 150}


def fitted(rows: Any, space: str = "cartesian", **memory: Any) -> Any:
    settings = FitSettings(GP, True, 0, 1, target_space=space, memory={"zeros": True} | memory)
    return fitted_model(MODELS["gp"], settings, rows)


@pytest.mark.parametrize("space", ["cartesian", "curvature"])
def test_memory_and_zero_take_the_error_down_to_the_noise(space: str) -> None:
    rows = recorded_arm(600, backlash=0.05, zeros_mm=(0.0, 3.0, -1.0))
    train, test = rows.take(np.arange(600) % 5 > 0), rows.take(np.arange(600) % 5 == 0)

    def error(**memory: Any) -> float:
        predicted = fitted(train, space, **memory).predict(test.inputs)
        return float(np.sqrt(np.square(predicted - test.positions).mean()))

    static, played = error(memory="none", zeros=False), error(memory="play", widths="all")
    assert played < 0.3 < error(memory="previous") < error(memory="none") < static


def test_zeros_are_those_of_the_sessions_and_average_to_none() -> None:
    rows = recorded_arm(900, zeros_mm=(0.0, 3.0, -1.5))
    model = fitted(rows, memory="none")
    np.testing.assert_allclose(model.zeros_[:, 0], [-0.5, 2.5, -2.0], atol=0.05)
    np.testing.assert_allclose(model.zeros_.mean(axis=0), 0.0, atol=1e-12)
    assert np.abs(model.zeros_[:, 1:]).max() < 0.05
    assert not model.zeros_of(np.array([7.0, 0.0])).any()  # a session never seen has the average zero
    assert model.zeros_of(np.array([2.0]))[0, 0] > 2


def test_uncertain_zeros_are_shrunk() -> None:
    """Noise alone makes no zeros, in most draws; what is certain stays."""
    found = []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        features, codes, noise = rng.uniform(-1, 1, (60, 2)), np.arange(60) % 2, rng.standard_normal((60, 3))
        found.append(np.ptp(session_zeros(features, 5 * noise, codes, 2), axis=0))
    assert np.median(found) == 0
    np.testing.assert_allclose(
        np.ptp(session_zeros(features, 0.01 * noise + codes[:, None], codes, 2), axis=0), 1, 0.05
    )


def test_gross_errors_do_not_move_a_zero() -> None:
    rows = recorded_arm(600, zeros_mm=(0.0, 2.0))
    rows.positions[::40] += 500.0
    assert np.ptp(fitted(rows, memory="none").zeros_[:, 0]) == pytest.approx(2.0, abs=0.3)


def test_bare_commands_are_sent_to_a_robot_at_rest() -> None:
    rows = recorded_arm(500, backlash=0.05)
    model = fitted(rows, memory="play", widths="all")
    commands = np.array([[0.8, -0.7], [0.3, 0.3]])
    out = commands - 0.1 * np.sign(commands)  # from rest, the play of the drive is taken up on the way out
    assert np.abs(model.predict(commands) - bent(out)).max() < 0.6
    np.testing.assert_array_equal(model.predict(model.inputs(commands)), model.predict(commands))


@pytest.mark.parametrize("memory", MEMORIES)
def test_it_is_stored_and_has_a_spread(memory: str, tmp_path: Any) -> None:
    rows = recorded_arm(200, backlash=0.05, zeros_mm=(0.0, 1.0))
    model = fitted(rows, memory=memory)
    joblib.dump(model, tmp_path / "model.joblib")
    again = joblib.load(tmp_path / "model.joblib")
    assert isinstance(again, InSessions)
    np.testing.assert_array_equal(again.predict(rows.inputs), model.predict(rows.inputs))
    spread = spread_of(MODELS["gp"], again, rows, rows.inputs[:20])
    assert spread.shape == (20, 3)
    assert (spread > 0).all()


def test_a_session_never_seen_is_zeroed_better_than_by_a_one_hot_input() -> None:
    """Issue 18: as an input of the regressor, sessions make those never seen worse."""
    rows = recorded_arm(900, zeros_mm=(0.0, 3.0, -2.0))
    known, new = rows.take(np.arange(900) < 600), rows.take(np.arange(900) >= 600)
    errors = new.positions - fitted(known, memory="none").predict(new.inputs)
    assert np.abs((errors - errors[:10].mean(axis=0))[10:]).mean() < 0.15
