"""Coverage and width in extrapolation of intervals made from outer shells of `train`, on stand-ins.

    python benchmarks/shells.py [--rows 400] [--seeds 2] [--first-seed 2026] [--copies 1] [--stuck 0]

Simulates each stand-in with `--rows` rows, seed by seed, fits every model in either target space with the
parameters of its first trial, and puts the intervals `auto` around it: coverage of extrapolation at 90 % and the
Winkler score over the oracle's, that of constant width and that which grows with the distance. Prints a line per
robot, space and model (means over seeds), and in how many cases 90 % are covered at no more than 1.5 times the score
of either oracle. `--rows 40 --copies 10 --seeds 4` makes robots of as few distinct commands as ELASTICA has (12 in
extrapolation: not assessable), `--stuck 0.01` robots that stay in the pose before in 1 % of all rows, as ABAQUS does.
Seeds below 1000 were used while the intervals were built.
"""

from __future__ import annotations

import argparse
import itertools
import logging
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from optuna.trial import FixedTrial

from softkin.core.metrics.interval import covered, winkler_scores
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, VALIDATION, Samples, informative_coordinates
from softkin.core.shells import command_norm
from softkin.data.standins import STANDINS
from softkin.data.standins.simulating import simulate
from softkin.models import MODELS
from softkin.models.target_spaces import TARGET_SPACES
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.training.refit_shells import cores_and_shells
from softkin.uncertainty.calibration_data import PointCalibration, Shell, ShellCalibration
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.labelled import LABELLED_METHODS
from softkin.uncertainty.labelled.spec import Labelled

LEVEL, LARGEST_RATIO = 0.9, 1.5
CORE_SHARES = (0.6, 0.7, 0.8, 0.9)
ORACLES = ("oracle_constant", "oracle")


def scores(subsets: dict[str, Samples], model: str, space: str, copies: int) -> list[float]:
    """Coverage of extrapolation, and Winkler score over that of each oracle."""
    spec = MODELS[model]
    params = spec.search_space(FixedTrial(dict(spec.first_trials[0])))
    settings = FitSettings(params, skip_constant=True, seed=0, threads=1, target_space=space)
    train, validation = subsets[TRAIN], subsets[VALIDATION]
    if copies > 1:  # copies of all rows in-domain, in calibration too
        parts = [subsets[name] for name in (TRAIN, VALIDATION, TEST)]
        commands, positions = (
            np.concatenate([getattr(part, name) for part in parts]) for name in ("commands", "positions")
        )
        train = validation = Samples(np.tile(commands, (copies, 1)), np.tile(positions, (copies, 1)))
    new = subsets[EXTRAPOLATION]

    def fitted(rows: NDArray[np.intp]) -> Any:
        return fitted_model(spec, settings, Samples(train.commands[rows], train.positions[rows]))

    norm = command_norm(train.commands, standardised=False).of
    whole = fitted(np.arange(len(train)))
    deployed = PointCalibration(
        whole.predict(validation.commands),
        validation.positions,
        whole.predict(new.commands),
        train_commands=train.commands,
        calibration_commands=validation.commands,
        new_commands=new.commands,
    )
    shells = [
        Shell(
            train.commands[core],
            train.commands[shell],
            fitted(core).predict(train.commands[shell]),
            train.positions[shell],
        )
        for core, shell in cores_and_shells(norm(train.commands), float(norm(new.commands).max()), CORE_SHARES)
    ]
    bounds = INTERVAL_METHODS["auto"].intervals(ShellCalibration(deployed, shells, norm), [LEVEL])[0]
    moving = informative_coordinates(train.positions)
    true, bounds = new.positions[:, moving], bounds[:, moving]
    labelled = Labelled(
        train.commands,
        validation.commands,
        (validation.positions - deployed.calibration)[:, moving],
        new.commands,
        (new.positions - deployed.new)[:, moving],
        norm,
    )
    score = winkler_scores(true, bounds, LEVEL).mean()
    found = [float(covered(true, bounds).mean())]
    for name in ORACLES:
        half = LABELLED_METHODS[name].answer(labelled, [LEVEL], 0).half_widths[0]
        found.append(score / winkler_scores(labelled.errors, np.stack([-half, half], axis=-1), LEVEL).mean())
    return found


def stuck(samples: Samples, share: float, seed: int) -> Samples:
    """A share of the rows in the pose of the row before."""
    rows = 1 + np.random.default_rng(seed).choice(len(samples) - 1, round(share * len(samples)), replace=False)
    positions = samples.positions.copy()
    positions[rows] = samples.positions[rows - 1]
    return Samples(samples.commands, positions)


def main() -> None:
    """Simulate, fit, score, and print a line per robot, target space and model."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--rows", type=int, default=400)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--first-seed", type=int, default=2026)
    parser.add_argument("--copies", type=int, default=1)
    parser.add_argument("--stuck", type=float, default=0.0)
    parser.add_argument("--models", nargs="+", default=list(MODELS), choices=list(MODELS))
    arguments = parser.parse_args()
    warnings.filterwarnings("ignore")
    logging.disable(logging.CRITICAL)
    holds: dict[tuple[str, str], list[bool]] = {}
    print(f"{'robot':<26}{'space':<11}{'model':<7}{'coverage':>10}" + "".join(f"{name:>17}" for name in ORACLES))
    for robot in STANDINS:
        simulated = [
            {
                name: stuck(rows, arguments.stuck, seed)
                for name, rows in simulate(robot, n_rows=arguments.rows, seed=seed).items()
            }
            for seed in range(arguments.first_seed, arguments.first_seed + arguments.seeds)
        ]
        for space, model in itertools.product(TARGET_SPACES, arguments.models):
            of_seeds = [scores(subsets, model, space, arguments.copies) for subsets in simulated]
            means = np.mean(of_seeds, axis=0)
            line = f"{robot:<26}{space:<11}{model:<7}{means[0]:>10.3f}"
            print(line + "".join(f"{ratio:>17.2f}" for ratio in means[1:]), flush=True)
            for name, place in zip(ORACLES, (1, 2), strict=True):
                held = [of[0] >= LEVEL and of[place] <= LARGEST_RATIO for of in of_seeds]
                holds.setdefault((robot, name), []).extend(held)
    for name in ORACLES:
        cases = list(itertools.chain.from_iterable(held for (_, of), held in holds.items() if of == name))
        print(f"all robots, {name}: both in {sum(cases)} of {len(cases)}")
    for (robot, name), cases in holds.items():
        print(f"{robot}, {name}: both in {sum(cases)} of {len(cases)}")


if __name__ == "__main__":
    main()
