"""How often a class of failures is found: on clean stand-ins and arms, with errors at random, and with a thin slab.

    python -m benchmarks.failures [--rows 900] [--seeds 20] [--robots pneumatic_arm ...] [--results results]

Each robot is simulated with `--rows` rows of `train`, seed by seed: as it is; with 2 % of its rows at poses of other
rows, anywhere (markers swapped, stuck); and with a slab of 2 % of the commands, by one of them, in which 8 of 10 rows
keep one pose, as ABAQUS does. Prints the share of seeds with a class; where there is one, of new rows: the share of the
slab and of all other rows where intervals at 90 % say that the pose may fail, the mean probability in the slab, and the
share that failed there. With `--results` then, by the `train` of each dataset of a finished run, what it finds.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import TRAIN, Samples
from softkin.data.standins import STANDINS
from softkin.data.table import read_subset
from softkin.uncertainty.failures import failure_class

SHARE, FAILS, N_NEW, LEVEL = 0.02, 0.8, 1500, 0.9
Spoilt = Callable[[Samples, np.random.Generator], tuple[Samples, NDArray[np.bool_], NDArray[np.bool_]]]


def main() -> None:
    """Print a line for each robot and kind of error."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=int, default=900)
    parser.add_argument("--seeds", type=int, default=20)
    without_sessions = [name for name, robot in STANDINS.items() if not robot.sessions]
    parser.add_argument("--robots", nargs="*", default=without_sessions)
    parser.add_argument("--results", type=Path)
    asked = parser.parse_args()
    columns = f"{'class':>7} {'slab':>7} {'others':>7} {'says':>7} {'failed':>7}"
    print(f"{'robot':<26} {'errors':<10} {columns}")
    kinds: dict[str, Spoilt] = {"none": as_it_is, "anywhere": anywhere, "slab": in_a_slab}
    for name in asked.robots:
        robots = [simulated(name, asked.rows, seed) for seed in range(asked.seeds)]
        for kind, spoil in kinds.items():
            found = [outcome(rows, spoil, asked.rows, seed) for seed, rows in enumerate(robots)]
            numbers = [of_seed for of_seed in found if of_seed is not None]
            means = np.mean(numbers, axis=0) if numbers else []
            shares = " ".join(f"{share:>7.1%}" for share in (len(numbers) / len(found), *means))
            print(f"{name:<26} {kind:<10} {shares}", flush=True)
    for table in sorted(asked.results.glob("*/table.parquet")) if asked.results else []:
        of_train = failure_class(read_subset(table, TRAIN))
        said = "no class" if of_train is None else f"a class: {of_train.n_failed} of {of_train.n_rows} rows failed"
        print(f"{table.parent.name:<26} {said}")


def simulated(name: str, rows: int, seed: int) -> Samples:
    """Rows of `train`, and `N_NEW` more."""
    rng, robot = np.random.default_rng(seed), STANDINS[name]
    commands = robot.draw(rows + N_NEW, rng)
    return Samples(commands, robot.poses(commands, rng))


def outcome(sound: Samples, spoil: Spoilt, rows: int, seed: int) -> tuple[float, float, float, float] | None:
    """Shares flagged in the slab and elsewhere, mean probability and share failed in the slab; None: no class."""
    samples, failed, slab = spoil(sound, np.random.default_rng(seed))
    of_train = failure_class(samples.take(np.arange(rows)))
    if of_train is None:
        return None
    new, slab, failed = samples.commands[rows:], slab[rows:], failed[rows:]
    flagged, probability = of_train.may_fail(new, [LEVEL])[0], of_train.probability(new)
    means = (flagged[slab].mean(), flagged[~slab].mean(), probability[slab].mean(), failed[slab].mean())
    return tuple(map(float, means))  # type: ignore[return-value]


def as_it_is(rows: Samples, rng: np.random.Generator) -> tuple[Samples, NDArray[np.bool_], NDArray[np.bool_]]:  # noqa: ARG001
    """Nothing fails."""
    none = np.zeros(len(rows), dtype=bool)
    return rows, none, none


def anywhere(rows: Samples, rng: np.random.Generator) -> tuple[Samples, NDArray[np.bool_], NDArray[np.bool_]]:
    """Some rows have the pose of another row, whatever their command."""
    failed = rng.uniform(size=len(rows)) < SHARE * FAILS
    positions = rows.positions.copy()
    positions[failed] = rows.positions[rng.integers(len(rows), size=int(failed.sum()))]
    return Samples(rows.commands, positions), failed, failed


def in_a_slab(rows: Samples, rng: np.random.Generator) -> tuple[Samples, NDArray[np.bool_], NDArray[np.bool_]]:
    """Most rows of a slab of one command keep the pose of one row far from it."""
    along = rows.commands[:, rng.integers(rows.commands.shape[1])]
    start = rng.uniform(0, 1 - SHARE)
    low, high = np.quantile(along, [start, start + SHARE])
    slab = (along >= low) & (along <= high)
    failed = slab & (rng.uniform(size=len(rows)) < FAILS)
    distance = np.linalg.norm(rows.positions - rows.positions[slab].mean(axis=0), axis=1)
    positions = rows.positions.copy()
    positions[failed] = rows.positions[np.argmax(distance)]
    return Samples(rows.commands, positions), failed, slab


if __name__ == "__main__":
    main()
