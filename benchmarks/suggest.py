"""Whether suggested commands teach a model more than random ones, on simulated robots.

python -m benchmarks.suggest [ROBOT ...] [--seeds N]: each robot is recorded at 100 commands as it is used to; then up
to 200 more are measured, between the bounds of those, chosen by a design or drawn at random, and the model is fitted
anew. Printed are the RMSE on fresh commands drawn at random between the bounds, and the share of rows that each design
needs for the error that 50 and 100 random commands reach: interpolated on geometric means over seeds, where an error
once reached counts as kept. Two models are taught, whose form is fixed, so that no design owes its place to one.

Designs: `suggest` is what softkin does, the command farthest from all before; `fill`, a Sobol' sequence that knows of
no command before; `widest`, distance times the width of the interval; `variance`, greedy reduction of the variance of a
Gaussian process, learnt on the first 100 rows, over 512 points (Cohn 1996).
"""

from __future__ import annotations

import argparse
import logging
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial.distance import cdist
from scipy.stats import qmc

from softkin.core.geometry.constant_curvature import from_arcs
from softkin.core.samples import Array, Samples
from softkin.data.standins import STANDINS
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.intervals import INTERVAL_METHODS

N_TRAIN, N_VALIDATION, N_FRESH, N_MORE, DRAWS = 100, 60, 400, 200, 2
ADDED = (0, 5, 10, 15, 20, 25, 30, 40, 50, 60, 75, 100, 125, 150, 200)
AS_GOOD_AS = (50, 100)
N_CANDIDATES, N_POINTS = 1024, 512
GP = {"kernel": "rbf", "trend": "linear", "max_iter": 20, "learning_rows": 200}
#: No seed of a configuration, a test, another benchmark, or of the trials by which the design was chosen.
FIRST_SEED = 6201


@dataclass(frozen=True)
class Robot:
    """A simulated robot: `draw(n_rows, rng)` of the commands that it is recorded at, `poses(commands, rng)` in mm, and
    the degree of the polynomial that it is fitted by.
    """

    draw: Callable[[int, np.random.Generator], Array]
    poses: Callable[[Array, np.random.Generator], Array]
    degree: int = 5


def with_gap(name: str) -> Robot:
    """A stand-in that was never sent commands of which both are positive."""
    whole = STANDINS[name]

    def draw(n_rows: int, rng: np.random.Generator) -> Array:
        commands = whole.draw(3 * n_rows, rng)
        return np.asarray(commands[~(commands > 0.1 * commands.max(axis=0)).all(axis=1)][:n_rows])

    return Robot(draw, whole.poses)


def six_commands() -> Robot:
    """An arm that bends and stretches by hyperbolic tangents of mixtures of six commands, measured to 0.05 mm."""
    linear, square = np.random.default_rng(FIRST_SEED - 1).standard_normal((2, 6, 3)) / np.sqrt(6)

    def poses(commands: Array, rng: np.random.Generator) -> Array:
        mixed = np.tanh(1.2 * commands @ linear + 0.5 * commands**2 @ square)
        arcs = np.column_stack([mixed[:, :2], 200 * (1 + 0.1 * mixed[:, 2])])
        return from_arcs(arcs[:, None, :]).reshape(len(commands), 3) + 0.05 * rng.standard_normal((len(commands), 3))

    return Robot(lambda n_rows, rng: rng.uniform(-1, 1, (n_rows, 6)), poses, degree=3)


def stand_in(name: str) -> Robot:
    """A stand-in as it is."""
    return Robot(STANDINS[name].draw, STANDINS[name].poses)


ROBOTS: Mapping[str, Robot] = {
    "pneumatic_arm": stand_in("pneumatic_arm"),
    "tendon_finger_frictional": stand_in("tendon_finger_frictional"),
    "six_commands": six_commands(),
    "frictional_with_gap": with_gap("tendon_finger_frictional"),
    "tendon_finger": stand_in("tendon_finger"),
}


def main() -> None:
    """Print a table for each robot and model."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", help=f"of {', '.join(ROBOTS)}; all where left out")
    parser.add_argument("--seeds", type=int, default=3)
    asked = parser.parse_args()
    if unknown := set(asked.robots) - set(ROBOTS):
        parser.error(f"no such robot: {', '.join(sorted(unknown))}")
    warnings.simplefilter("ignore")
    logging.disable(logging.WARNING)
    for name in asked.robots or ROBOTS:
        curves: dict[tuple[str, str], list[list[float]]] = {}
        for seed in range(FIRST_SEED, FIRST_SEED + asked.seeds):
            for model, design, errors in taught(ROBOTS[name], seed):
                curves.setdefault((model, design), []).append(errors)
        for model in ("gp", "ridge"):
            print(f"\n{name}, {model}: RMSE in mm after 0, 25, 50, 100, 200 more rows; share for the error of "
                  f"{' and '.join(map(str, AS_GOOD_AS))} random ones")  # fmt: skip
            print("\n".join(table({design: means(of) for (one, design), of in curves.items() if one == model})))
        print(end="", flush=True)


def taught(robot: Robot, seed: int) -> Iterator[tuple[str, str, list[float]]]:
    """(model, design, RMSE in mm after each number of `ADDED` rows)."""
    rng = np.random.default_rng(seed)
    commands = robot.draw(N_TRAIN + N_VALIDATION, rng)
    rows = Samples(commands, robot.poses(commands, rng))
    train, validation = rows.take(slice(N_TRAIN)), rows.take(slice(N_TRAIN, None))
    lower, upper = train.commands.min(axis=0), train.commands.max(axis=0)
    asked = rng.uniform(lower, upper, (N_FRESH, len(lower)))
    fresh = Samples(asked, robot.poses(asked, rng))
    settings: dict[str, dict[str, Any]] = {"gp": GP, "ridge": {"degree": robot.degree, "alpha": 1e-6}}
    fitted = fitted_model(MODELS["gp"], FitSettings(GP, True, 0, 1), train)
    model = FittedModel("robot", MODELS["gp"], "tuned", fitted, train)
    known = calibrated(model, INTERVAL_METHODS["scp_spread"], validation)
    for design, chosen in designs(known, rng, seed):
        order = rng.permutation(N_MORE)  # a robot that remembers is sent no design in its own order
        positions = np.empty((N_MORE, rows.positions.shape[1]))
        positions[order] = robot.poses(chosen[order], rng)
        for name, params in settings.items():
            errors = []
            for n in ADDED:
                more = Samples(
                    np.vstack([train.commands, chosen[:n]]), np.vstack([train.positions, positions[:n]])
                )  # fmt: skip
                again = fitted_model(MODELS[name], FitSettings(params, True, 0, 1), more)
                off = np.asarray(again.predict(fresh.commands)) - fresh.positions
                errors.append(float(np.sqrt(np.square(off).mean())))
            yield name, design, errors


def designs(robot: CalibratedModel, rng: np.random.Generator, seed: int) -> Iterator[tuple[str, Array]]:
    """Names and commands (N_MORE, n_commands), in the order in which they are added; `random` several times."""
    train = robot.train.commands
    lower, upper = train.min(axis=0), train.max(axis=0)
    for _ in range(DRAWS):
        yield "random", rng.uniform(lower, upper, (N_MORE, len(lower)))
    yield "suggest", robot.suggest(N_MORE, seed=seed).iloc[:, : len(lower)].to_numpy()

    def filled(n_rows: int) -> Array:
        return np.asarray(qmc.scale(qmc.Sobol(len(lower), rng=rng).random(n_rows), lower, upper))

    yield "fill", filled(256)[:N_MORE]
    candidates = filled(N_CANDIDATES)
    bounds = np.asarray(robot.intervals(candidates, 0.9))
    yield "widest", candidates[widest((bounds[..., 1] - bounds[..., 0]).mean(axis=1), candidates, train)]
    yield "variance", candidates[reducing(robot, candidates, filled(N_POINTS))]


def widest(width: Array, candidates: Array, train: Array) -> list[int]:
    """Greedy: the largest width times distance to what was measured or chosen before."""
    scale = np.ptp(train, axis=0)
    distances, places = cdist(candidates / scale, train / scale).min(axis=1), []
    for _ in range(N_MORE):
        places.append(int(np.argmax(width * distances)))
        distances = np.minimum(distances, np.linalg.norm((candidates - candidates[places[-1]]) / scale, axis=1))
    return places


def reducing(robot: CalibratedModel, candidates: Array, points: Array) -> list[int]:
    """Greedy: the candidate that takes most off the variance of the robot's Gaussian process over the points."""
    scaler, process = (step for _, step in robot.estimator.regressor_.steps)
    kernel = process.posterior_.kernel_
    known, asked = scaler.transform(robot.train.commands), scaler.transform(np.vstack([candidates, points]))
    noise = float(kernel(known[:1])[0, 0] - kernel(known[:1], known[:1])[0, 0])
    matrix = kernel(known) + 1e-8 * np.eye(len(known))
    left = kernel(asked, asked) - kernel(asked, known) @ np.linalg.solve(matrix, kernel(known, asked))
    places, n = [], len(candidates)
    for _ in range(N_MORE):
        own = np.maximum(np.diag(left)[:n], 0.0) + noise + 1e-8
        places.append(int(np.argmax(np.square(left[:n, n:]).sum(axis=1) / own)))
        column = left[:, places[-1]].copy()
        left -= np.outer(column, column) / own[places[-1]]
    return places


def means(errors: list[list[float]]) -> Array:
    """Geometric means (n_added,) over seeds and draws."""
    return np.asarray(np.exp(np.log(errors).mean(axis=0)))


def table(curves: Mapping[str, Array]) -> Iterator[str]:
    """A line for each design."""
    for design, curve in curves.items():
        shown = " ".join(f"{curve[ADDED.index(n)]:>9.3g}" for n in (0, 25, 50, 100, 200))
        shares = [share(curve, curves["random"][ADDED.index(n)], n) for n in AS_GOOD_AS]
        yield f"  {design:<9}{shown}   {'  '.join(f'{one:>5}' for one in shares)}"


def share(curve: Array, error: float, n_random: int) -> str:
    """How many of `n_random` rows a design needs for this error."""
    best = np.minimum.accumulate(curve)
    if best[-1] > error:
        return f">{N_MORE / n_random:.0%}"
    place = int(np.argmax(best <= error))
    if place == 0:
        return "0%"
    before, after = np.log(best[place - 1 : place + 1])
    rows = np.interp(np.log(error), [after, before], [ADDED[place], ADDED[place - 1]])
    return f"{rows / n_random:.0%}"


if __name__ == "__main__":
    main()
