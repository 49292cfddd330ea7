"""Small calibrated models of every kind that is exported."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

import numpy as np

from softkin.core.samples import Params, Samples
from softkin.core.shells import command_norm
from softkin.models import MODELS
from softkin.models.estimators.weighted_mean import weighted_mean
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.calibration_data import Shell
from softkin.uncertainty.failures import failure_class
from softkin.uncertainty.held_out_difficulty import fit_difficulty
from softkin.uncertainty.intervals import INTERVAL_METHODS
from tests.conftest import bending_arm
from tests.contract import laws
from tests.recorded_robot import recorded_arm

TRAIN, VALIDATION = (bending_arm(n, n_markers=2, seed=n) for n in (50, 60))
#: Inside and outside.
NEW = bending_arm(80, seed=3, largest_command=1.7).commands
BASE = {"origin": [0, 0, 0], "axis": [0, 0, 1]}
METHODS = ("scp_mapie", "scp_distance", "cps", "scp_crepes")


@cache
def small(name: str) -> CalibratedModel:
    """A robot of this point model; the target space, the method and whether there are shells take turns."""
    spec, place = MODELS[name], list(MODELS).index(name)
    params: Params = laws.first_params(spec)[-1]
    params = {key: min(value, 6) if key in ("n_estimators", "max_iter") else value for key, value in params.items()}
    space = ("cartesian", "curvature")[place % 2]
    settings = FitSettings(params, True, 0, 1, target_space=space, base=BASE)
    model = FittedModel(name, spec, "tuned", fitted_model(spec, settings, TRAIN), TRAIN)
    norm, shells = command_norm(TRAIN.commands, standardised=place % 4 == 0).of, []
    core = norm(TRAIN.commands) <= np.quantile(norm(TRAIN.commands), 0.6)
    outer = TRAIN.take(~core)
    errors = np.random.default_rng(0).normal(size=outer.positions.shape) * norm(outer.commands)[:, None] ** 2
    shells.append(Shell(TRAIN.commands[core], outer.commands, outer.positions + errors, outer.positions))
    method = "scp_spread" if spec.spread is not None else METHODS[place % len(METHODS)]
    has_shells = place % 3 < 2
    return calibrated(
        model, INTERVAL_METHODS[method], VALIDATION, shells if has_shells else (), norm if has_shells else None
    )


@cache
def remembering(memory: str = "play") -> CalibratedModel:
    """A polynomial of a robot recorded in three sessions."""
    rows = recorded_arm(240, backlash=0.05, zeros_mm=(0.0, 2.0, -2.0))
    fitted, held_out = rows.take(np.arange(240) % 4 > 0), rows.take(np.arange(240) % 4 == 0)
    told = {"memory": memory, "widths": "fine", "zeros": True}
    settings = FitSettings({"degree": 2, "alpha": 1e-3}, True, 0, 1, memory=told)
    model = FittedModel("remembers", MODELS["ridge"], "tuned", fitted_model(MODELS["ridge"], settings, fitted), fitted)
    return calibrated(model, INTERVAL_METHODS["scp_crepes"], held_out)


@cache
def mean_of(*names: str) -> CalibratedModel:
    """The weighted mean of robots, with the intervals of the first."""
    robots = [ROBOTS[name]() for name in names]
    weights = np.arange(1.0, len(names) + 1)
    return replace(
        robots[0], estimator=weighted_mean([one.estimator for one in robots], weights / weights.sum(), names)
    )


@cache
def recalibrated() -> CalibratedModel:
    """The same in a new session."""
    commands = 0.5 * NEW[:6]
    positions = np.asarray(remembering().follow(commands)) + 1.0
    return replace(remembering().recalibrate(commands, positions))


@cache
def hard_somewhere() -> CalibratedModel:
    """A polynomial whose errors on held-out rows differ by place and by coordinate, one of them constant; commands on a
    grid have neighbours at equal distances.
    """
    axis = np.linspace(-1, 1, 15)
    commands = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    hard = [10 ** commands[:, 0], 10 ** np.linalg.norm(commands, axis=1), np.ones(len(commands))]
    errors = np.abs(np.random.default_rng(0).standard_normal((len(commands), 3))) * np.column_stack(hard)
    difficulty = fit_difficulty(commands, errors, np.array([0, 1, 2, -1, 0, 1]))
    settings = FitSettings({"degree": 2, "alpha": 1e-3}, True, 0, 1)
    estimator = fitted_model(MODELS["ridge"], settings, TRAIN)
    model = FittedModel("hard", MODELS["ridge"], "tuned", estimator, TRAIN, difficulty)
    return calibrated(model, INTERVAL_METHODS["scp_held_out"], VALIDATION)


@cache
def failing() -> CalibratedModel:
    """A polynomial, of an arm that keeps one pose at the commands of a slab."""
    rows = bending_arm(600, n_markers=2, seed=5)
    in_slab = (rows.commands[:, 0] > 0.5) & (rows.commands[:, 0] < 0.6)
    positions = np.where(in_slab[:, None], [60.0, -60.0, 20.0, 90.0, -90.0, 30.0], rows.positions)
    known = failure_class(Samples(rows.commands, positions))
    assert known is not None
    return replace(small("ridge"), failures=known)


@cache
def noiseless() -> CalibratedModel:
    """A Gaussian process of an arm without noise: its weights are large, of either sign, and cancel."""
    commands = np.random.default_rng(0).uniform(-1, 1, (200, 2))
    u, v = commands.T
    rows = Samples(commands, np.column_stack([60 * np.sin(u), 60 * np.sin(v), 100 * np.cos(u) * np.cos(v)]))
    train, held_out = rows.take(np.arange(200) < 150), rows.take(np.arange(200) >= 150)
    params: Params = {"kernel": "rbf", "trend": "linear", "max_iter": 15, "initial_length_scale": 8.0}
    settings = FitSettings(params | {"initial_noise": 1e-9}, True, 0, 1)
    model = FittedModel("noiseless", MODELS["gp"], "tuned", fitted_model(MODELS["gp"], settings, train), train)
    return calibrated(model, INTERVAL_METHODS["scp_crepes"], held_out)


ROBOTS: dict[str, Callable[[], CalibratedModel]] = {name: partial(small, name) for name in MODELS}
ROBOTS |= {"remembers": remembering, "previous": lambda: remembering("previous"), "recalibrated": recalibrated}
ROBOTS |= {"hard somewhere": hard_somewhere, "failing": failing}
ROBOTS |= {"mean": partial(mean_of, "lr", "huber"), "mean in sessions": partial(mean_of, "remembers", "previous")}
