"""How long one command takes with a 90 % interval, inside and outside, beside the bare estimator: median and p99.

    python -m benchmarks.latency results/finger/calibrated_model.joblib ...

Without a file: a polynomial and a Gaussian process on a made-up arm of 1,000 rows of `train`, with shells. One command
at a time, in process, on one thread (OMP_NUM_THREADS=1).
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from softkin.core.samples import Array, Params, Samples
from softkin.core.shells import command_norm
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.calibration_data import Shell
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.loading import load

N_TRAIN, N_VALIDATION, N_CALLS, N_MANY, LEVEL = 1000, 300, 1000, 100_000, 0.9


def main() -> None:
    """Print a line for each model."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*", help="calibrated_model.joblib")
    asked = parser.parse_args()
    robots = [load(path) for path in asked.models] or list(made_up())
    print(f"{'robot, model, method':<42} {'what':<9} {'median ms':>10} {'p99 ms':>8} {'bare ms':>8} {'ratio':>6}")
    for robot in robots:
        title = f"{robot.dataset}, {robot.spec.name}, {robot.method.name}"
        for where, commands in places(robot).items():
            bare = milliseconds(robot.estimator.predict, [row[None] for row in commands])
            whole = milliseconds(partial(robot.intervals, confidence_levels=LEVEL), list(commands))
            middle, late, plain = (
                float(value) for value in (np.median(whole), np.quantile(whole, 0.99), np.median(bare))
            )
            print(f"{title:<42} {where:<9} {middle:>10.3f} {late:>8.3f} {plain:>8.3f} {middle / plain:>6.2f}")
        many = np.resize(robot.train.commands, (N_MANY, robot.train.commands.shape[1]))
        plain, middle = (min(milliseconds(call, [many] * 3)) for call in (robot.estimator.predict, robot_at(robot)))
        print(f"{title:<42} {'100,000':<9} {middle:>10.0f} {'':>8} {plain:>8.0f} {middle / plain:>6.2f}")


def robot_at(robot: CalibratedModel) -> Callable[[Array], object]:
    """What is timed: bounds at 90 %."""
    return lambda rows: robot.intervals(rows, LEVEL)


def places(robot: CalibratedModel) -> dict[str, Array]:
    """Commands inside, those of `train`, and outside, twice as far out."""
    rows = np.resize(robot.train.commands, (N_CALLS, robot.train.commands.shape[1]))
    farther = rows.mean(axis=0) + 3.0 * (rows - rows.mean(axis=0))
    return {"inside": rows, "outside": np.resize(farther[np.asarray(robot.is_outside(farther))], rows.shape)}


def milliseconds(call: Callable[[Array], object], arguments: list[Array]) -> list[float]:
    """Wall time of each call, after one that is not counted."""
    call(arguments[0])
    taken = []
    for argument in arguments:
        start = time.perf_counter()
        call(argument)
        taken.append(1e3 * (time.perf_counter() - start))
    return taken


def made_up() -> Iterator[CalibratedModel]:
    """A polynomial and a Gaussian process, with shells of half and of 70 % of the rows."""
    settings: dict[str, Params] = {
        "ridge": {"degree": 3, "alpha": 1e-3},
        "gp": {"kernel": "rbf", "trend": "linear", "max_iter": 5},
    }
    train, validation = arm(N_TRAIN, 0), arm(N_VALIDATION, 1)
    norm = command_norm(train.commands, standardised=False).of
    for name, params in settings.items():
        fit = FitSettings(params, skip_constant=True, seed=0, threads=1)
        norms, shells = norm(train.commands), []
        for share in (0.5, 0.7):
            core = norms <= np.quantile(norms, share)
            predicted = fitted_model(MODELS[name], fit, train.take(core)).predict(train.commands[~core])
            shells.append(Shell(train.commands[core], train.commands[~core], predicted, train.positions[~core]))
        model = FittedModel("arm", MODELS[name], "tuned", fitted_model(MODELS[name], fit, train), train)
        for method in ("scp_mapie", *(["scp_spread"] if MODELS[name].spread else [])):
            yield replace(calibrated(model, INTERVAL_METHODS[method], validation, shells, norm))


def arm(n_rows: int, seed: int) -> Samples:
    """A constant-curvature arc of 100 mm, two commands, noise of 0.1 mm."""
    rng = np.random.default_rng(seed)
    commands = rng.uniform(-1, 1, (n_rows, 2))
    bend = np.hypot(*commands.T)[:, None] + 1e-9
    position = np.hstack([100 * (1 - np.cos(bend)) / bend**2 * commands, 100 * np.sin(bend) / bend])
    return Samples(commands, position + 0.1 * rng.standard_normal(position.shape))


if __name__ == "__main__":
    main()
