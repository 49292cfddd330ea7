"""Every combination of model, target space, memory, ensemble and interval method is exported, or refused in a sentence.

That what is written in Python and in C answers as its numbers do is tested in `test_exports`; here are the numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from softkin.core.errors import ConfigError
from softkin.core.samples import Params
from softkin.models import MODELS
from softkin.models.estimators.weighted_mean import weighted_mean
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.export.face import Model
from softkin.uncertainty.export.numbers import exported_numbers
from softkin.uncertainty.export.onnx_file import onnx_file
from softkin.uncertainty.held_out_difficulty import fit_difficulty
from softkin.uncertainty.intervals import INTERVAL_METHODS
from tests.contract import laws
from tests.exported_robots import BASE, NEW, TRAIN, VALIDATION
from tests.recorded_robot import recorded_arm

LEVEL, PARITY = 0.9, 1e-9
SPACES = ("cartesian", "curvature")
EXPORTED = ("scp_mapie", "scp_crepes", "scp_distance", "scp_held_out", "cps")
REFUSED = tuple(name for name, method in INTERVAL_METHODS.items() if method.scaled is None)
RECORDED = recorded_arm(160, backlash=0.05, zeros_mm=(0.0, 2.0))


def params_of(name: str) -> Params:
    params: Params = laws.first_params(MODELS[name])[-1]
    return {key: min(value, 4) if key in ("n_estimators", "max_iter") else value for key, value in params.items()}


@cache
def fitted(name: str, space: str, memory: str | None = None) -> FittedModel:
    """A model with a difficulty by errors that are made up."""
    rows = TRAIN if memory is None else RECORDED
    told = None if memory is None else {"memory": memory, "widths": "fine", "zeros": True}
    settings = FitSettings(params_of(name), True, 0, 1, target_space=space, base=BASE, memory=told)
    errors = np.random.default_rng(0).exponential(1.0, rows.positions.shape) * np.exp(2 * rows.commands[:, :1])
    difficulty = fit_difficulty(rows.commands, errors, np.arange(rows.positions.shape[1]))
    estimator = fitted_model(MODELS[name], settings, rows)
    return FittedModel("arm", MODELS[name], "tuned", estimator, rows, difficulty)


def robots(model: FittedModel, *methods: str) -> Iterator[CalibratedModel]:
    """With each of these interval methods, and with those of its spread."""
    held_out = VALIDATION if model.train is TRAIN else RECORDED
    has_spread = model.spec.spread is not None and model.train is TRAIN
    for method in (*methods, *(["scp_spread", "gaussian"] if has_spread else [])):
        yield calibrated(model, INTERVAL_METHODS[method], held_out)


@pytest.fixture(autouse=True)
def rounding_is_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is told by many single answers of the model."""
    monkeypatch.setattr("softkin.uncertainty.export.numbers.known_to", lambda _: "")


def refusal(call: Callable[[], object]) -> ConfigError | None:
    try:
        call()
    except ConfigError as error:
        return error
    return None


def is_exported(robot: CalibratedModel) -> bool:
    """Whether it is exported, and then answers as the model does; ONNX is refused in a sentence, or written."""
    refused = refusal(lambda: exported_numbers(robot, [LEVEL], most=30_000_000))
    if refused is not None:
        assert refused.where == "arm"
        assert refused.fix
        return False
    model: Any = Model(exported_numbers(robot, [LEVEL], most=30_000_000))
    np.testing.assert_allclose(model.predict(NEW), robot.predict(NEW), rtol=0, atol=PARITY)
    np.testing.assert_allclose(model.intervals(NEW, LEVEL), robot.intervals(NEW, LEVEL), rtol=0, atol=PARITY)
    np.testing.assert_array_equal(model.is_outside(NEW), robot.is_outside(NEW))
    no_onnx = refusal(lambda: onnx_file(robot, [LEVEL]))
    assert no_onnx is None or ("ONNX" in str(no_onnx) and no_onnx.fix)
    return True


@pytest.mark.parametrize("name", MODELS)
def test_each_model_in_each_target_space_with_each_method(name: str) -> None:
    for space, methods in zip(SPACES, (EXPORTED, EXPORTED[3:4]), strict=True):
        for robot in robots(fitted(name, space), *methods):
            assert is_exported(robot), (space, robot.method.name)
    for method in REFUSED:
        assert not is_exported(replace(robot, method=INTERVAL_METHODS[method])), method


@pytest.mark.parametrize("memory", ["previous", "play"])
@pytest.mark.parametrize("name", ["ridge", "xgb"])
def test_robots_that_remember(name: str, memory: str) -> None:
    for robot in robots(fitted(name, "cartesian", memory), "scp_crepes", "scp_distance"):
        assert is_exported(robot), robot.method.name


def test_ensembles_of_all_models() -> None:
    members = [fitted(name, space) for name, space in zip(MODELS, SPACES * len(MODELS), strict=False)]
    shares = np.full(len(members), 1 / len(members))
    estimator = weighted_mean([one.estimator for one in members], shares.tolist(), list(MODELS))
    for method in EXPORTED[2:4]:
        robot = calibrated(replace(members[0], estimator=estimator), INTERVAL_METHODS[method], VALIDATION)
        assert is_exported(robot), method
