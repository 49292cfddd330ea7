"""What every point model must be in plain numbers: the same answers, at once and from one row."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from softkin.core.samples import Samples
from softkin.models import MODELS
from softkin.models.plain.describe import described, standardised
from softkin.models.plain.evaluate import KINDS, regressor
from softkin.models.plain.kernels import Node
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibration_data import PointCalibration
from softkin.uncertainty.intervals import INTERVAL_METHODS
from tests.conftest import bending_arm
from tests.contract import laws

TRAIN = bending_arm(70, n_commands=3, n_markers=2, seed=1)
NEW = bending_arm(60, n_commands=3, n_markers=2, seed=2, largest_command=1.6).commands
CASES = [(name, place) for name, spec in MODELS.items() for place in range(1 + min(3, len(spec.first_trials)))]


@cache
def case(name: str, place: int) -> tuple[Any, Node, Samples]:
    """Estimator, its node, and the standardised rows that it was fitted on."""
    spec = MODELS[name]
    params = [spec.paper_params, *laws.first_params(spec)][place]
    params = {key: min(value, 20) if key in ("n_estimators", "max_iter") else value for key, value in params.items()}
    estimator = fitted_model(spec, FitSettings(params, skip_constant=True, seed=0, threads=1), TRAIN)
    scaler, fitted = estimator.regressor_[0], estimator.regressor_[-1]
    known = Samples(scaler.transform(TRAIN.commands), estimator.transformer_.transform(TRAIN.positions))
    return estimator, standardised(scaler, described(fitted, known if spec.spread else None)), known


@pytest.mark.parametrize(("name", "place"), CASES)
def test_plain_numbers_answer_as_the_model_does(name: str, place: int) -> None:
    estimator, node, known = case(name, place)
    targets, spread = regressor(node)(NEW)
    np.testing.assert_allclose(targets, estimator.targets(NEW), rtol=0, atol=1e-12)
    for row in (0, 7):
        # One row is another sum: the weights of a Gaussian process are large, and their sum is not.
        one = regressor(node)(NEW[row : row + 1])[0][0]
        np.testing.assert_allclose(one, targets[row], rtol=0, atol=1e-9 if name == "gp" else 1e-12)
    spec = MODELS[name]
    assert (spread is not None) == (spec.spread is not None)
    if spread is not None:
        assert spec.spread is not None
        said = spec.spread(estimator.regressor_[-1], known, estimator.regressor_[0].transform(NEW))
        np.testing.assert_allclose(spread, said, rtol=1e-6, atol=1e-12)


def test_every_kind_is_of_some_model() -> None:
    def kinds(node: Any) -> set[str]:
        if isinstance(node, list):
            return set().union(*map(kinds, node))
        if not isinstance(node, dict):
            return set()
        return {node["kind"]} & set(KINDS) | set().union(*map(kinds, node.values())) if "kind" in node else set()

    assert set().union(*(kinds(case(*one)[1]) for one in CASES)) == set(KINDS)


def test_methods_around_a_point_model_are_known_in_plain_numbers() -> None:
    for method in INTERVAL_METHODS.values():
        if issubclass(method.calibrated_on, PointCalibration):
            assert method.scaled is not None, method.name
