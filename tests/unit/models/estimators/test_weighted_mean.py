from __future__ import annotations

import io
from typing import Any

import joblib
import numpy as np
import pytest

from softkin.core.samples import Samples
from softkin.models import MODELS
from softkin.models.estimators.in_sessions import InSessions
from softkin.models.estimators.weighted_mean import (
    MeanInSessions,
    WeightedMean,
    composition,
    weighted_mean,
    weighted_sum,
)
from softkin.training.kinematic_model import FitSettings, fitted_model
from tests.conftest import bending_arm
from tests.recorded_robot import recorded_arm

WEIGHTS, NAMES = [0.25, 0.75], ["lr tuned", "ridge outer"]


def members(rows: Samples) -> list[Any]:
    """A line in positions that is told nothing, and a cubic in arcs that is told the previous command."""
    line = FitSettings({}, True, 0, 1, memory={"memory": "none", "zeros": False})
    memory = {"memory": "previous", "zeros": True}
    cubic = FitSettings({"degree": 3, "alpha": 1e-3}, True, 0, 1, target_space="curvature", memory=memory)
    return [fitted_model(MODELS["lr"], line, rows), fitted_model(MODELS["ridge"], cubic, rows)]


def test_it_predicts_the_weighted_mean_and_is_the_same_when_stored() -> None:
    rows, probe = bending_arm(60), bending_arm(20, seed=1).commands
    of_members = members(rows)
    mean = weighted_mean(of_members, WEIGHTS, NAMES)
    assert isinstance(mean, WeightedMean)
    expected = 0.25 * of_members[0].predict(probe) + 0.75 * of_members[1].predict(probe)
    np.testing.assert_allclose(mean.predict(probe), expected, rtol=1e-12)
    assert composition(mean) == " of 75 % ridge outer, 25 % lr tuned"
    file = io.BytesIO()
    joblib.dump(mean, file)
    file.seek(0)
    np.testing.assert_array_equal(joblib.load(file).predict(probe), mean.predict(probe))


@pytest.fixture(scope="module")
def recorded() -> tuple[Samples, list[Any], Any]:
    rows = recorded_arm(300, backlash=0.05, zeros_mm=(0.0, 3.0, -1.5))
    of_members = members(rows)
    return rows, of_members, weighted_mean(of_members, WEIGHTS, NAMES)


def test_of_recorded_rows_each_member_is_told_what_it_was_fitted_with(recorded: Any) -> None:
    rows, of_members, mean = recorded
    assert isinstance(mean, MeanInSessions)
    assert isinstance(mean, InSessions), "what follows a robot through time asks for that"
    for probe in (rows.inputs[:50], rows.commands[:50]):
        expected = 0.25 * of_members[0].predict(probe) + 0.75 * of_members[1].predict(probe)
        np.testing.assert_allclose(mean.predict(probe), expected, rtol=1e-12)


def test_it_knows_the_sessions_and_the_mean_of_their_zeros(recorded: Any) -> None:
    rows, of_members, mean = recorded
    assert mean.sessions_.tolist() == [1.0, 2.0, 3.0]
    assert mean.zeros is True
    np.testing.assert_allclose(mean.zeros_, 0.75 * of_members[1].zeros_)
    np.testing.assert_array_equal(mean.robot.rest, rows.recording.robot.rest)
    shifted = rows.inputs[:1].copy()
    shifted[:, -1] = 0.0  # no session of the recording
    np.testing.assert_allclose(
        mean.predict(rows.inputs[:1]) - mean.predict(shifted), mean.zeros_of(rows.inputs[:1, -1]), atol=1e-9
    )


def test_a_member_alone_is_that_itself() -> None:
    (line, _), array = members(bending_arm(30)), np.ones(3)
    assert weighted_mean([line], [1.0], ["lr tuned"]) is line
    assert composition(line) == ""
    assert weighted_sum([array], [1.0]) is array


def test_a_member_that_lacks_a_session_adds_no_zero_to_it() -> None:
    """Of many rows some are drawn for a fit, and a short session may have none of them."""
    rows = recorded_arm(300, backlash=0.05, zeros_mm=(0.0, 3.0, -1.5))
    assert rows.recording is not None
    session = rows.recording.session
    without = members(rows.take(session != 2))
    of_members = [without[0], members(rows)[1]]
    mean = weighted_mean(of_members, WEIGHTS, NAMES)
    assert mean.sessions_.tolist() == [1, 2, 3]
    in_second = rows.inputs[session == 2]
    expected = 0.25 * of_members[0].predict(in_second) + 0.75 * of_members[1].predict(in_second)
    np.testing.assert_allclose(mean.predict(in_second), expected, rtol=1e-12)
    np.testing.assert_allclose(mean.zeros_of(np.array([2.0])), 0.75 * of_members[1].zeros_of(np.array([2.0])))
