from __future__ import annotations

import importlib.util

import numpy as np
import pytest

from softkin.core.errors import ConfigError
from softkin.uncertainty.export.onnx_file import onnx_file
from tests.asked_onnx import answers, needs_onnx
from tests.exported_robots import NEW, ROBOTS, noiseless

LEVELS = [0.7, 0.9]
#: mm.
PARITY = 1e-9
REFUSED = {
    "rf": "as wide as a spread, which ONNX has no operator to solve for",
    "gp": "as wide as a spread",
    "mlp": "as wide as a spread",
    "gb": "a model of kind 'trees'",
    "xgb": "a model of kind 'trees'",
    "remembers": "a graph of ONNX has no state",
    "previous": "no state",
    "recalibrated": "no state",
    "mean in sessions": "no state",
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_written_says_so(name: str) -> None:
    with pytest.raises(ConfigError, match=REFUSED[name]):
        onnx_file(ROBOTS[name](), LEVELS)


def test_without_the_extra_there_is_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    with pytest.raises(ConfigError, match="onnx is not installed: it cannot be written as ONNX"):
        onnx_file(ROBOTS["ridge"]())


@needs_onnx
@pytest.mark.parametrize("name", sorted(set(ROBOTS) - set(REFUSED)))
def test_it_answers_as_the_model(name: str) -> None:
    robot = ROBOTS[name]()
    said, bounds = answers(onnx_file(robot, LEVELS), NEW), np.asarray(robot.intervals(NEW, LEVELS))
    np.testing.assert_allclose(said["position"], robot.predict(NEW), rtol=0, atol=PARITY)
    np.testing.assert_allclose(said["lower"], bounds[..., 0], rtol=0, atol=PARITY)
    np.testing.assert_allclose(said["upper"], bounds[..., 1], rtol=0, atol=PARITY)
    np.testing.assert_array_equal(said["outside"][:, 0], robot.is_outside(NEW))
    assert ("may_fail" in said) == (robot.failures is not None)
    if robot.failures is not None:
        np.testing.assert_array_equal(said["failure_probability"][:, 0], robot.failure_probability(NEW))
        np.testing.assert_array_equal(said["may_fail"][..., 0], robot.failures.may_fail(NEW, LEVELS))


@needs_onnx
@pytest.mark.parametrize("name", ["huber", "noiseless"])
def test_ten_thousand_commands_of_a_polynomial_and_a_gaussian_process(name: str) -> None:
    robot = noiseless() if name == "noiseless" else ROBOTS[name]()
    commands = np.random.default_rng(1).uniform(-1.4, 1.4, (10_000, 2))
    said, plain = answers(onnx_file(robot, LEVELS), commands), robot._prepared.plain
    predicted = plain.placed(commands)[0]
    bounds = np.asarray(robot.intervals(commands, LEVELS, predicted))
    np.testing.assert_allclose(said["position"], predicted, rtol=0, atol=PARITY)
    for side, name_of in enumerate(("lower", "upper")):
        np.testing.assert_allclose(said[name_of], bounds[..., side], rtol=0, atol=PARITY)
    np.testing.assert_array_equal(said["outside"][:, 0], robot.is_outside(commands))
    for row in range(0, len(commands), 500):
        np.testing.assert_allclose(said["position"][row], robot.predict(commands[row])[0], rtol=0, atol=PARITY)
