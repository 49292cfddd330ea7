"""What curvature coordinates are worth outside the training shell, on simulated rods: much to a model that goes on."""

from __future__ import annotations

import pytest

from softkin.core.metrics.point import rmse_mm
from softkin.core.samples import EXTRAPOLATION, TRAIN, Params, Samples
from softkin.data.standins.simulating import simulate
from softkin.models import MODELS
from softkin.models.target_spaces import TARGET_SPACES
from softkin.training.fit import fit_quietly, kinematic_model

#: Models that continue the shape they saw.
GO_ON = [("lr", {"degree": d}) for d in (1, 2, 3)] + [("ridge", {"degree": 2, "alpha": 1e-3})]
GO_ON += [("lasso", {"degree": 2, "alpha": 1e-3}), ("huber", {"degree": 2, "epsilon": 1.35, "alpha": 1e-4})]
#: That end at a constant, or at a trend.
STAY = [("rf", {"n_estimators": 50}), ("svr", {})]
ON_A_TREND = [(model, params | {"trend": trend}) for model, params in (*STAY, ("gb", {}), ("xgb", {}))
              for trend in ("linear", "quadratic")]  # fmt: skip
NETWORK = {"solver": "lbfgs", "activation": "tanh", "layers": 2, "width": 16, "alpha": 1e-2, "max_iter": 600}
ON_A_TREND += [("mlp", NETWORK | {"trend": "linear"})]
#: What may be left, at most, of the error in positions.
LARGEST_RATIO = {"tendon_finger": 0.2, "pneumatic_arm": 0.5}


@pytest.fixture(scope="module", params=LARGEST_RATIO)
def robot(request: pytest.FixtureRequest) -> tuple[str, dict[str, Samples]]:
    return request.param, simulate(request.param, n_rows=300, seed=3)


def ratio(robot: dict[str, Samples], model: str, params: Params) -> float:
    """Error on extrapolation in curvature coordinates by that in positions."""
    outside, errors = robot[EXTRAPOLATION], {}
    for space in TARGET_SPACES:
        estimator = kinematic_model(MODELS[model], params, skip_constant=True, seed=0, threads=1, target_space=space)
        fit_quietly(estimator, robot[TRAIN], 1)
        errors[space] = rmse_mm(outside.positions, estimator.predict(outside.commands))
    return errors["curvature"] / errors["cartesian"]


@pytest.mark.parametrize(("model", "params"), GO_ON + ON_A_TREND)
def test_a_model_that_goes_on_is_far_better_in_arcs(
    robot: tuple[str, dict[str, Samples]], model: str, params: Params
) -> None:
    name, samples = robot
    assert ratio(samples, model, params) < LARGEST_RATIO[name]


@pytest.mark.parametrize(("model", "params"), STAY)
def test_a_model_that_ends_at_a_constant_gains_nothing(
    robot: tuple[str, dict[str, Samples]], model: str, params: Params
) -> None:
    assert 0.9 < ratio(robot[1], model, params) < 1.2
