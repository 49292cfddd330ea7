"""Positions -> arcs -> positions, and what a model in curvature coordinates is worth in extrapolation."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.core.metrics.point import rmse_mm
from softkin.core.samples import EXTRAPOLATION, TRAIN, Params, Samples
from softkin.data.standins.simulating import simulate
from softkin.models import MODELS
from softkin.models.target_spaces import TARGET_SPACES
from softkin.models.target_spaces.curvature import SPACE, CurvatureCoordinates
from softkin.training.kinematic_model import FitSettings, fitted_model
from tests.conftest import bending_arm

UPRIGHT = {"origin": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0]}


def near_constant_arm(size: float) -> Samples:
    """An arm whose base moves by `size` (mm) along z, in proportion to its first command."""
    samples = bending_arm(80, n_markers=3)
    positions = samples.positions.copy()
    positions[:, 2] = size * samples.commands[:, 0]
    return Samples(samples.commands, positions)


@pytest.mark.parametrize("size", [0.0, 1e-37, 1e-9])
def test_a_near_constant_coordinate_comes_back_and_a_constant_one_is_no_target(size: float) -> None:
    samples = near_constant_arm(size)
    space = CurvatureCoordinates().fit(samples.positions, samples.commands)
    targets = space.transform(samples.positions)
    moving = CurvatureCoordinates().fit(bending_arm(80, n_markers=3).positions, samples.commands)
    assert targets.shape[1] == moving.n_arcs_ + (size > 0)
    back = space.inverse_transform(targets)
    np.testing.assert_allclose(back[:, 3:], samples.positions[:, 3:], atol=1e-8)
    np.testing.assert_allclose(back[:, :3], samples.positions[:, :3], rtol=1e-9, atol=1e-9 * size)
    spread = space.inverse_spread(targets, np.ones_like(targets))
    assert (spread[:, :2] == 0).all()
    np.testing.assert_allclose(spread[:, 2], samples.positions[:, 2].std(), rtol=1e-9, atol=0)
    assert (spread[:, 3:] > 0).all()


def test_a_model_in_arcs_predicts_near_constant_coordinates_as_one_in_positions_does() -> None:
    """R2 over all coordinates, as the paper has it, counts them."""
    samples = near_constant_arm(1e-37)
    settings = FitSettings({"degree": 1}, skip_constant=True, seed=0, threads=1, target_space="curvature")
    estimator = fitted_model(MODELS["lr"], settings, samples)
    np.testing.assert_allclose(
        estimator.predict(samples.commands)[:, 2], samples.positions[:, 2], rtol=1e-6, atol=1e-43
    )


def test_targets_are_standardised_arcs_of_the_declared_base() -> None:
    samples = bending_arm(80)
    targets = SPACE.transformer(True, UPRIGHT).fit(samples.positions, samples.commands).transform(samples.positions)
    np.testing.assert_allclose(targets.std(axis=0), 1.0)
    for bending, command in zip(targets.T[:2], samples.commands.T, strict=True):
        assert np.corrcoef(bending, command)[0, 1] > 0.999


def test_a_spread_in_positions_is_the_change_with_a_small_change_of_the_targets() -> None:
    samples = bending_arm(80)
    space = CurvatureCoordinates(base=UPRIGHT).fit(samples.positions, samples.commands)
    targets = space.transform(samples.positions)
    spread = np.zeros_like(targets)
    spread[:, 0] = 1e-4
    change = np.abs(space.inverse_transform(targets + spread) - space.inverse_transform(targets - spread)) / 2
    np.testing.assert_allclose(space.inverse_spread(targets, spread), change, rtol=1e-3, atol=1e-9)


def test_positions_that_no_arc_leads_to_are_named_with_the_fix() -> None:
    rows = bending_arm(30)
    positions = rows.positions.copy()
    positions[7] = [0.0, 0.0, -50.0]
    with pytest.raises(DataError, match="1 positions lie at the base or straight behind it") as caught:
        CurvatureCoordinates(base=UPRIGHT).fit(positions, rows.commands)
    assert caught.value.where == "row 7, marker 1"
    assert "-50.0" in caught.value.what
    assert caught.value.fix is not None
    assert "target_spaces: [cartesian]" in caught.value.fix


def test_a_robot_that_never_moves_has_no_arcs() -> None:
    rows = bending_arm(30)
    with pytest.raises(DataError, match="no marker moves") as caught:
        CurvatureCoordinates(base=UPRIGHT).fit(np.broadcast_to(rows.positions[:1], (30, 3)), rows.commands)
    assert caught.value.fix == "set target_spaces: [cartesian]"


#: Models that continue the shape they are fitted on.
CONTINUING: list[tuple[str, Params]] = [("lr", {"degree": d}) for d in (1, 2, 3)]
CONTINUING += [("ridge", {"degree": 2, "alpha": 1e-3})]
CONTINUING += [("lasso", {"degree": 2, "alpha": 1e-3}), ("huber", {"degree": 2, "epsilon": 1.35, "alpha": 1e-4})]
#: Models that end at a constant, or at a trend.
ENDING: list[tuple[str, Params]] = [("rf", {"n_estimators": 50}), ("svr", {})]
FEW_TREES: Params = {"n_estimators": 20}
ON_A_TREND = [(model, params | {"trend": trend}) for model, params in (*ENDING, ("gb", FEW_TREES), ("xgb", FEW_TREES))
              for trend in ("linear", "quadratic")]  # fmt: skip
NETWORK: Params = {"solver": "lbfgs", "activation": "tanh", "layers": 2, "width": 16, "alpha": 1e-2, "max_iter": 600}
ON_A_TREND += [("mlp", NETWORK | {"trend": "linear"})]
#: Largest ratio of the error in curvature coordinates to that in positions, by stand-in.
LARGEST_RATIO = {"tendon_finger": 0.2, "pneumatic_arm": 0.5}


@pytest.fixture(scope="module", params=LARGEST_RATIO)
def robot(request: pytest.FixtureRequest) -> tuple[str, dict[str, Samples]]:
    return request.param, simulate(request.param, n_rows=300, seed=3)


def ratio(robot: dict[str, Samples], model: str, params: Params) -> float:
    """Error on extrapolation in curvature coordinates by that in positions."""
    new, errors = robot[EXTRAPOLATION], {}
    for space in TARGET_SPACES:
        settings = FitSettings(params, skip_constant=True, seed=0, threads=1, target_space=space)
        errors[space] = rmse_mm(
            new.positions, fitted_model(MODELS[model], settings, robot[TRAIN]).predict(new.commands)
        )
    return errors["curvature"] / errors["cartesian"]


@pytest.mark.parametrize(("model", "params"), CONTINUING + ON_A_TREND)
def test_a_model_that_continues_its_shape_is_far_better_in_arcs(
    robot: tuple[str, dict[str, Samples]], model: str, params: Params
) -> None:
    name, samples = robot
    assert ratio(samples, model, params) < LARGEST_RATIO[name]


@pytest.mark.parametrize(("model", "params"), ENDING)
def test_a_model_that_ends_at_a_constant_gains_nothing(
    robot: tuple[str, dict[str, Samples]], model: str, params: Params
) -> None:
    assert 0.9 < ratio(robot[1], model, params) < 1.2
